#pragma once

#include "core/imageio/image_io.h"

#include <string>

/// The one function of the library lrsm_picture_file, which `readImage` loads when a picture is first read: OpenImageIO brings 260 shared libraries, 0.3 s
/// at every start of a program that links it.
namespace lrsm {

struct PictureFile {
    LayeredImage image;
    float largestCode = 0.0f;  ///< of integer pictures, 2^n - 1: values are codes over it, to a rounding; 0 where the file holds floats
};

/// Any file that OpenImageIO reads, values as they are stored. InputError as of `readImage`.
extern "C" void lrsmReadPictureFile(const std::string& path, PictureFile& file);

}  // namespace lrsm
