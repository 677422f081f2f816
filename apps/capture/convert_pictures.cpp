#include "apps/capture/convert.h"
#include "apps/capture/fill.h"

namespace lrsm {

namespace {

std::size_t pixelsOf(const Capture& capture)
{
    return static_cast<std::size_t>(capture.width) * static_cast<std::size_t>(capture.height);
}

template <class T>
Image<T> imageFrom(const Capture& capture, const std::string& name, Dtype dtype = Dtype::f4)
{
    Image<T> image;
    image.texels = copyFrom<T>(capture, name, dtype, pixelsOf(capture));
    image.width = capture.width;
    image.height = capture.height;
    return image;
}

}  // namespace

void toBuffers(const GBuffer& gbuffer, std::vector<Buffer>& buffers)
{
    copyTo(buffers, "gbuffer.position", gbuffer.position.texels);
    copyTo(buffers, "gbuffer.geometric_normal", gbuffer.geometricNormal.texels);
    copyTo(buffers, "gbuffer.normal", gbuffer.normal.texels);
    copyTo(buffers, "gbuffer.albedo", gbuffer.albedo.texels);
    copyTo(buffers, "gbuffer.specular_color", gbuffer.specularColor.texels);
    copyTo(buffers, "gbuffer.roughness", gbuffer.roughness.texels);
    copyTo(buffers, "gbuffer.depth", gbuffer.depthLinear.texels);
    copyTo(buffers, "gbuffer.object_id", gbuffer.objectId.texels);
}

GBuffer gbufferFromCapture(const Capture& capture)
{
    GBuffer gbuffer;
    gbuffer.width = capture.width;
    gbuffer.height = capture.height;
    gbuffer.position = imageFrom<Vec3>(capture, "gbuffer.position");
    gbuffer.geometricNormal = imageFrom<Vec3>(capture, "gbuffer.geometric_normal");
    gbuffer.normal = imageFrom<Vec3>(capture, "gbuffer.normal");
    gbuffer.albedo = imageFrom<Vec3>(capture, "gbuffer.albedo");
    if (capture.needs.specular) {
        gbuffer.specularColor = imageFrom<Vec3>(capture, "gbuffer.specular_color");
        gbuffer.roughness = imageFrom<float>(capture, "gbuffer.roughness");
    }
    gbuffer.depthLinear = imageFrom<float>(capture, "gbuffer.depth");
    gbuffer.objectId = imageFrom<std::uint32_t>(capture, "gbuffer.object_id", Dtype::u4);
    return gbuffer;
}

void toBuffers(const Gathered& gathered, std::vector<Buffer>& buffers)
{
    copyTo(buffers, "cones.irradiance", gathered.irradiance.texels);
    copyTo(buffers, "cones.opacity", gathered.opacity.texels);
}

void toBuffers(const ConeRecord& cones, std::vector<Buffer>& buffers)
{
    copyTo(buffers, "cones.diffuse", cones.diffuse);
    copyTo(buffers, "cones.specular", cones.specular.texels);
}

Gathered gatheredFromCapture(const Capture& capture)
{
    Gathered gathered;
    gathered.irradiance = imageFrom<Vec3>(capture, "cones.irradiance");
    gathered.opacity = imageFrom<float>(capture, "cones.opacity");
    if (capture.needs.specular) {
        const auto cones = copyFrom<Vec4>(capture, "cones.specular", Dtype::f4, pixelsOf(capture));
        gathered.specular = Image<Vec3>(capture.width, capture.height);
        for (std::size_t i = 0; i < cones.size(); ++i) gathered.specular.texels[i] = Vec3(cones[i]);
    }
    return gathered;
}

void toBuffers(const Image<Vec3>& picture, const std::string& name, std::vector<Buffer>& buffers)
{
    copyTo(buffers, name, picture.texels);
}

Image<Vec3> pictureFromCapture(const Capture& capture, const std::string& name)
{
    return imageFrom<Vec3>(capture, name);
}

Image<Vec3> irradianceFromCapture(const Capture& capture)
{
    return pictureFromCapture(capture, capture.settings.cones.set.filter ? "filter.irradiance" : "cones.irradiance");
}

}  // namespace lrsm
