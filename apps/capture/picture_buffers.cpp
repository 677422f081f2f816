#include "apps/capture/picture_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"
#include "conetrace/frame/lobe.h"

namespace lrsm {

namespace {

using Names = Catalogue::Names;

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

bool samplesLobes(const Settings& settings)
{
    return (settings.method == Method::lrsm || settings.method == Method::vct) && SpecularLobes(settings.cones).sampling();
}

bool filtersLobes(const Settings& settings)
{
    return samplesLobes(settings) && settings.cones.set.filter;
}

void describeGBuffer(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const Aabb& bounds = frame.scene.bounds;
    const Tolerance length = tolerances::length(bounds.empty() ? 0.0 : double(glm::length(bounds.extent())), frame.height);
    const auto picture = [&](const std::string& name, const Names& components, const Catalogue::Text& text, const Tolerance& tolerance,
                             Dtype dtype = Dtype::f4) { out.picture("gbuffer." + name, frame.width, frame.height, components, text, tolerance, dtype); };
    picture("position", kXyz, {"of the surface; 0 where nothing was drawn, as all below", kWorldSpace, "m"}, length);
    picture("geometric_normal", kXyz, {"of the triangle, unit, towards the eye", kWorldSpace, ""}, tolerances::kSurface);
    picture("normal", kXyz, {"shading normal, unit, towards the eye", kWorldSpace, ""}, tolerances::surfaceNormal(frame.height));
    picture("albedo", kRgb, {"diffuse", "linear", ""}, tolerances::kSurface);
    if (frame.needs.specular) {
        picture("specular_color", kRgb, {"F0; 0 where the material has no specular part", "linear", ""}, tolerances::kSurface);
        picture("roughness", {}, {"perceptual: GGX alpha is its square", "", ""}, tolerances::kSurface);
    }
    picture("depth", {}, {"along the viewing axis", "eye", "m"}, length);
    picture("object_id", {}, {"mesh + 1; 0 where nothing was drawn", "", ""}, tolerances::kObjectId, Dtype::u4);
}

void describeDirect(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    out.picture("direct.radiance", frame.width, frame.height, kRgb, {"direct light reflected towards the eye", kPicture, kRadianceUnit}, tolerances::kDirect);
}

void describeCones(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const int width = frame.width, height = frame.height;
    const ConeSettings& cones = frame.settings.cones;
    out.add("cones.diffuse", Dtype::f4,
            {static_cast<std::size_t>(cones.set.count * cones.set.setsPerPixel), static_cast<std::size_t>(height), static_cast<std::size_t>(width)},
            {"cone", "row", "column"}, kRgbOpacity, {"I of Eq. 1 and opacity of each diffuse cone, in the order of their sum", kPicture, kRadianceUnit},
            tolerances::kCones);
    out.picture("cones.irradiance", width, height, kRgb, {"pi times the weighted sum of the diffuse cones", kPicture, kIrradianceUnit}, tolerances::kCones);
    out.picture("cones.opacity", width, height, {}, {"weighted mean opacity of the diffuse cones", kPicture, ""}, tolerances::kConeOpacity);
    if (!frame.needs.specular) return;
    out.picture("cones.specular", width, height, kRgbOpacity, {"I and opacity of the specular cone", kPicture, kRadianceUnit}, tolerances::kCones);
    if (samplesLobes(frame.settings))
        out.picture("cones.lobe_weight", width, height, {}, {"what the specular cone's direction counts in the mean over the lobe", kPicture, ""},
                    tolerances::kSurface);
}

void describeFilter(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    out.picture("filter.irradiance", frame.width, frame.height, kRgb, {"irradiance averaged over 4x4 pixels of the same surface", kPicture, kIrradianceUnit},
                tolerances::kFilter);
}

void describeSpecularFilter(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    out.picture("filter.specular", frame.width, frame.height, kRgb,
                {"mean radiance over the lobe: 4x4 pixels of the same surface, by their lobe weights", kPicture, kRadianceUnit}, tolerances::kFilter);
}

void describeSmooth(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    out.picture("smooth.irradiance", frame.width, frame.height, kRgb, {"irradiance smoothed by wider taps on the same surface", kPicture, kIrradianceUnit},
                tolerances::kFilter);
}

void describeComposite(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const auto picture = [&](const std::string& name, const std::string& meaning, const Tolerance& tolerance) {
        out.picture("composite." + name, frame.width, frame.height, kRgb, {meaning, kPicture, kRadianceUnit}, tolerance);
    };
    picture("diffuse", "albedo irradiance / pi", tolerances::kProduct);
    picture("specular", "specular cone times the lobe's directional albedo", tolerances::kSpecularPart);
    picture("combined", "direct + diffuse + specular", tolerances::kProduct);
}

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
    // By other settings (check's hints) there may be none.
    if (!gathered.lobeWeight.empty()) copyTo(buffers, "cones.lobe_weight", gathered.lobeWeight.texels);
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
        if (samplesLobes(capture.settings)) gathered.lobeWeight = imageFrom<float>(capture, "cones.lobe_weight");
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

bool filtersIrradiance(const Settings& settings)
{
    const bool alternates = settings.method != Method::proxies && (settings.method != Method::ism || settings.ism.interleave);
    return settings.cones.set.filter && alternates;
}

Image<Vec3> filteredFromCapture(const Capture& capture)
{
    return pictureFromCapture(capture, filtersIrradiance(capture.settings) ? "filter.irradiance" : "cones.irradiance");
}

Image<Vec3> irradianceFromCapture(const Capture& capture)
{
    return filtersIrradiance(capture.settings) && capture.settings.cones.set.smoothingPasses() > 0 ? pictureFromCapture(capture, "smooth.irradiance")
                                                                                                   : filteredFromCapture(capture);
}

Image<Vec3> specularFromCapture(const Capture& capture)
{
    if (!capture.needs.specular) return {};
    return filtersLobes(capture.settings) ? pictureFromCapture(capture, "filter.specular") : gatheredFromCapture(capture).specular;
}

}  // namespace lrsm
