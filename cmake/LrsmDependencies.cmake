# What the libraries need. Everything comes from Debian packages (scripts/setup.sh); nothing is downloaded at build time. An installed
# tree holds this file too: find_package(lrsm) reads it.
find_package(glm REQUIRED)
find_package(TBB REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
if(LRSM_PASSES_ONLY)
  return()
endif()

find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
find_package(OpenImageIO REQUIRED)  # reads pictures
find_package(OpenEXR REQUIRED)      # writes them
find_package(PNG REQUIRED)
find_package(meshoptimizer REQUIRED)
# Debian 12's libwebp brings no package file.
if(NOT TARGET WebP::webp)
  find_path(WEBP_INCLUDE_DIR webp/decode.h REQUIRED)
  find_library(WEBP_LIBRARY webp REQUIRED)
  add_library(WebP::webp UNKNOWN IMPORTED)
  set_target_properties(WebP::webp PROPERTIES IMPORTED_LOCATION "${WEBP_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${WEBP_INCLUDE_DIR}")
endif()

# Debian's OpenImageIO target names include folders of packages that are not installed; CMake refuses those.
block()
  foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders OpenImageIO::OpenImageIO ${property})
    if(folders)
      set(present "")
      foreach(folder IN LISTS folders)
        if(EXISTS "${folder}")
          list(APPEND present "${folder}")
        endif()
      endforeach()
      set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${present}")
    endif()
  endforeach()
endblock()
