// Terms that a pass may have forgotten, or taken twice.
#include "apps/capture/passes.h"
#include "apps/check/hint_trial.h"
#include "core/scene/camera.h"

#include <algorithm>
#include <map>

namespace lrsm {

namespace {

/// The buffer of the same pass and texels, or nullptr.
const Buffer* sibling(const HintTrial& trial, const std::string& name)
{
    const Buffer* buffer = trial.inputs().find(name);
    return buffer && !buffer->bytes.empty() ? buffer : nullptr;
}

std::string replaced(std::string name, const std::string& what, const std::string& by)
{
    const std::size_t at = name.find(what);
    return at == std::string::npos ? std::string() : name.replace(at, what.size(), by);
}

/// Ranges of the layers as they are stored.
std::vector<LayerRange> rangesOf(const HintTrial& trial)
{
    const std::size_t light = lightOfPass(trial.expected().pass);
    return light < trial.inputs().lights.size() ? trial.inputs().lights[light].storedRanges() : std::vector<LayerRange>();
}

void suspectLrsm(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    const std::size_t perLayer = b.shape.empty() || b.shape[0] == 0 ? 1 : b.elements() / b.shape[0];
    const bool radiance = b.name.find(".radiance.") != std::string::npos;
    const Buffer* depth = b.name.find(".depth.") != std::string::npos ? &b : sibling(trial, replaced(b.name, radiance ? ".radiance." : ".normal.", ".depth."));
    if (!depth) return;
    const auto alphaAt = [&](std::size_t i) { return decodedValue(*depth, i - i % 4 + 2); };
    const bool isDepth = depth == &b, isNormal = b.name.find(".normal.") != std::string::npos;
    const auto isAlpha = [&](std::size_t i) { return (isDepth && i % 4 == 2) || (isNormal && i % 4 == 3); };

    trial.suspect("values are not multiplied by alpha, the fraction of texels that are in the layer", [&](std::size_t i) {
        const double alpha = alphaAt(i);
        return isAlpha(i) || alpha == 0.0 ? trial.expectedAt(i) : trial.expectedAt(i) / alpha;
    });
    trial.suspect("values are multiplied by alpha twice", [&](std::size_t i) { return isAlpha(i) ? trial.expectedAt(i) : trial.expectedAt(i) * alphaAt(i); });
    if (isDepth || isNormal)
        trial.suspect("alpha is 1 wherever it is not 0: it must be the fraction of texels in the layer",
                      [&](std::size_t i) { return isAlpha(i) ? (trial.expectedAt(i) > 0.0 ? 1.0 : 0.0) : trial.expectedAt(i); });
    if (!isDepth) return;

    trial.suspect("'z2' is the square of the mean depth, not the mean of squares", [&](std::size_t i) {
        const double z = decodedValue(b, i - i % 4), alpha = alphaAt(i);
        return i % 4 != 1 || alpha == 0.0 ? trial.expectedAt(i) : z * z / alpha;
    });
    trial.suspect("'z2' is the square of 'z' as stored", [&](std::size_t i) {
        const double z = decodedValue(b, i - i % 4);
        return i % 4 == 1 ? z * z : trial.expectedAt(i);
    });
    const std::vector<LayerRange> ranges = rangesOf(trial);
    if (ranges.size() != b.shape[0]) return;
    trial.suspect("depths are not warped to the layer's own range", [&](std::size_t i) {
        const LayerRange& range = ranges[i / perLayer];
        const double w = double(range.depthMax) - double(range.depthMin), m = range.depthMin, alpha = alphaAt(i);
        const double z = decodedValue(b, i - i % 4), z2 = decodedValue(b, i - i % 4 + 1);
        if (i % 4 == 0) return std::clamp(z * w + m * alpha, 0.0, 1.0);
        if (i % 4 == 1) return std::clamp(z2 * w * w + 2.0 * z * w * m + alpha * m * m, 0.0, 1.0);
        return trial.expectedAt(i);
    });
    trial.suspect("depths run backwards in the layer's range: 1 - z", [&](std::size_t i) {
        const double z = decodedValue(b, i - i % 4), z2 = decodedValue(b, i - i % 4 + 1), alpha = alphaAt(i);
        return i % 4 == 0 ? alpha - z : i % 4 == 1 ? alpha - 2.0 * z + z2 : trial.expectedAt(i);
    });
}

/// Texels in layers that are not theirs. What a layer holds is a sum over its texels: radiance, normal and alpha of several layers add up.
void suspectLayers(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    const std::vector<LayerRange> ranges = rangesOf(trial);
    if (b.shape.size() != 4 || ranges.size() != b.shape[0] || ranges.size() < 2) return;
    const bool isDepth = b.name.find(".depth.") != std::string::npos;
    const std::size_t perLayer = b.elements() / b.shape[0];
    const auto adds = [&](std::size_t i) { return !isDepth || i % 4 == 2; };
    const auto sumOver = [&](std::size_t i, auto&& joins) {
        double sum = 0.0;
        for (std::size_t layer = 0; layer < ranges.size(); ++layer)
            if (joins(ranges[layer], ranges[i / perLayer])) sum += trial.expectedAt(layer * perLayer + i % perLayer);
        return sum;
    };
    trial.suspect("texels of all depth slices are in every layer", [&](std::size_t i) {
        return adds(i) ? sumOver(i, [](const LayerRange& a, const LayerRange& own) { return a.nDotLMin == own.nDotLMin; }) : trial.candidateAt(i);
    });
    trial.suspect("texels of all <n.l> slices are in every layer", [&](std::size_t i) {
        return adds(i) ? sumOver(i, [](const LayerRange& a, const LayerRange& own) { return a.depthMin == own.depthMin; }) : trial.candidateAt(i);
    });
    if (isDepth) return;
    constexpr double kRounding = 0x1p-9;  // of a half, times the layers
    trial.suspect("texels went to other layers: summed over the layers nothing is missing (which side do a layer's ends belong to?)", [&](std::size_t i) {
        double expected = 0.0, candidate = 0.0, size = 0.0;
        for (std::size_t layer = 0; layer < ranges.size(); ++layer) {
            expected += trial.expectedAt(layer * perLayer + i % perLayer);
            candidate += trial.candidateAt(layer * perLayer + i % perLayer);
            size += std::abs(trial.expectedAt(layer * perLayer + i % perLayer));
        }
        return std::abs(expected - candidate) <= kRounding * size ? trial.candidateAt(i) : trial.expectedAt(i);
    });
}

void suspectRsm(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    if (b.name.find(".radiance") == std::string::npos) return;
    const Buffer* normal = sibling(trial, replaced(b.name, ".radiance", ".normal"));
    if (!normal) return;
    const auto cosine = [&](std::size_t i) { return decodedValue(*normal, i - i % 4 + 3); };
    for (const auto& [factor, also] : {std::pair(1.0, ""), std::pair(double(kPi), ", and not divided by pi")})
        trial.suspect(std::string("radiance is not multiplied by <n.l>") + also, [&, factor = factor](std::size_t i) {
            return i % 4 == 3 || cosine(i) <= 0.0 ? trial.expectedAt(i) : trial.expectedAt(i) * factor / cosine(i);
        });
    trial.suspect("radiance is multiplied by <n.l> twice", [&](std::size_t i) { return i % 4 == 3 ? trial.expectedAt(i) : trial.expectedAt(i) * cosine(i); });
}

/// x, y, z of the texel that element i of a three-component picture is in.
Vec3 vectorAt(const Buffer& buffer, std::size_t texel)
{
    return Vec3(float(decodedValue(buffer, texel * 3)), float(decodedValue(buffer, texel * 3 + 1)), float(decodedValue(buffer, texel * 3 + 2)));
}

void suspectGBuffer(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    const Capture& in = trial.inputs();
    const Camera& camera = in.camera;
    const Vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const auto toEye = [&](const Vec3& v) { return Vec3(glm::dot(v, right), glm::dot(v, camera.up), -glm::dot(v, camera.forward)); };
    const Buffer* position = sibling(trial, "gbuffer.position");
    const Buffer* ids = sibling(trial, "gbuffer.object_id");
    const auto covered = [&](std::size_t texel) { return !ids || decodedValue(*ids, texel) != 0.0; };
    if (b.components.size() == 3 && b.components[0] == "x") {
        const Vec3 origin = b.name == "gbuffer.position" ? camera.position : Vec3(0.0f);
        trial.suspect("in the eye's space (the world's is expected)", [&](std::size_t i) {
            return covered(i / 3) ? double(toEye(vectorAt(b, i / 3) - origin)[static_cast<int>(i % 3)]) : trial.expectedAt(i);
        });
        trial.suspect("in units of the scene's bounds, 0 to 1", [&](std::size_t i) {
            const int c = static_cast<int>(i % 3);
            return double((vectorAt(b, i / 3)[c] - in.sceneBounds.min[c]) / (in.sceneBounds.max[c] - in.sceneBounds.min[c]));
        });
    }
    if (b.name != "gbuffer.depth" || !position) return;
    trial.suspect("the distance from the eye, not along the viewing axis",
                  [&](std::size_t i) { return covered(i) ? double(glm::length(vectorAt(*position, i) - camera.position)) : trial.expectedAt(i); });
    const Mat4 clip = clipFromWorld(camera, in.width, in.height, in.sceneBounds);
    trial.suspect("z / w of clip space, not metres", [&](std::size_t i) {
        const Vec4 p = clip * Vec4(vectorAt(*position, i), 1.0f);
        return covered(i) && p.w != 0.0f ? double(p.z / p.w) : trial.expectedAt(i);
    });
}

/// Pictures: products of which a factor is left out.
void suspectShading(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    const Buffer* albedo = sibling(trial, "gbuffer.albedo");
    if (b.components.size() != 3 || !albedo || albedo->elements() != b.elements()) return;
    for (const auto& [factor, also] : {std::pair(1.0, ""), std::pair(double(kPi), ", and not divided by pi")})
        trial.suspect(std::string("not multiplied by the albedo") + also, [&, factor = factor](std::size_t i) {
            const double a = decodedValue(*albedo, i);
            return a > 0.0 ? trial.expectedAt(i) / a * factor : trial.candidateAt(i);
        });
    trial.suspect("multiplied by the albedo twice", [&](std::size_t i) { return trial.expectedAt(i) * decodedValue(*albedo, i); });
    trial.suspect("multiplied by the albedo, which is not expected here",
                  [&](std::size_t i) { return trial.expectedAt(i) * decodedValue(*albedo, i) / double(kPi); });

    if (b.name != "composite.combined") return;
    for (const auto& [sign, text] : {std::pair(-1.0, " is not in the sum"), std::pair(1.0, " is in the sum twice")})
        for (const char* name : {"direct.radiance", "composite.diffuse", "composite.specular"})
            if (const Buffer* part = sibling(trial, name))
                trial.suspect(std::string(name) + text, [&, sign = sign](std::size_t i) { return trial.expectedAt(i) + sign * decodedValue(*part, i); });
}

/// The irradiance filter with one of its rules left out.
void suspectFilter(HintTrial& trial)
{
    const Capture& in = trial.inputs();
    const Buffer* irradiance = sibling(trial, "cones.irradiance");
    const Buffer *position = sibling(trial, "gbuffer.position"), *normal = sibling(trial, "gbuffer.normal"),
                 *geometric = sibling(trial, "gbuffer.geometric_normal"), *ids = sibling(trial, "gbuffer.object_id");
    if (!irradiance || !position || !normal || !geometric || !ids) return;
    struct Rules {
        const char* text;
        bool halfEdges, normals, planes;
        int low, high;
        double divisor = 0.0;  ///< 0: the sum of the weights
    };
    constexpr float kCosine = 0.9f, kSlope = 0.1f;  // irradiance_filter.cpp
    for (const Rules& rules :
         {Rules{"outer rows and columns count whole, not half", false, true, true, -2, 2},
          Rules{"neighbours' normals are not compared", true, false, true, -2, 2},
          Rules{"neighbours' distance from the plane is not compared", true, true, false, -2, 2},
          Rules{"neighbours are not compared: all covered pixels count", true, false, false, -2, 2},
          Rules{"a box of 3x3 pixels, not 5x5 with half edges", false, true, true, -1, 1}, Rules{"a box of 4x4 pixels, not centred", false, true, true, -2, 1},
          Rules{"a box of 4x4 pixels, not centred", false, true, true, -1, 2},
          Rules{"divided by all weights (16), not by those of the neighbours that count", true, true, true, -2, 2, 16.0},
          Rules{"divided by 25, not by the weights of the neighbours that count", false, true, true, -2, 2, 25.0}}) {
        const auto filtered = [&](std::size_t i) {
            const auto pixel = i / 3, width = static_cast<std::size_t>(in.width);
            if (decodedValue(*ids, pixel) == 0.0) return trial.expectedAt(i);
            const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
            double sum = 0.0, total = 0.0;
            for (int dy = rules.low; dy <= rules.high; ++dy)
                for (int dx = rules.low; dx <= rules.high; ++dx) {
                    if (x + dx < 0 || y + dy < 0 || x + dx >= in.width || y + dy >= in.height) continue;
                    const std::size_t other = static_cast<std::size_t>(y + dy) * width + static_cast<std::size_t>(x + dx);
                    if (decodedValue(*ids, other) == 0.0) continue;
                    if (other != pixel && rules.normals && glm::dot(vectorAt(*normal, pixel), vectorAt(*normal, other)) < kCosine) continue;
                    const Vec3 between = vectorAt(*position, other) - vectorAt(*position, pixel);
                    const float limit = kSlope * glm::length(between);
                    if (other != pixel && rules.planes &&
                        (std::abs(glm::dot(between, vectorAt(*geometric, pixel))) > limit || std::abs(glm::dot(between, vectorAt(*geometric, other))) > limit))
                        continue;
                    const double weight = rules.halfEdges ? (std::abs(dx) == 2 ? 0.5 : 1.0) * (std::abs(dy) == 2 ? 0.5 : 1.0) : 1.0;
                    sum += weight * decodedValue(*irradiance, other * 3 + i % 3);
                    total += weight;
                }
            return sum / (rules.divisor > 0.0 ? rules.divisor : total);
        };
        trial.suspect(rules.text, filtered);
    }
}

/// The base level, from the RSM's 2x2 block.
void suspectBlock(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    if (levelOf(b.name) != 0 || b.shape.size() != 4) return;
    const std::string map = "rsm" + std::to_string(lightOfPass(b.pass)) + ".";
    const Buffer* coverage = sibling(trial, map + "radiance");
    const bool radiance = b.name.find(".radiance.") != std::string::npos, normal = b.name.find(".normal.") != std::string::npos;
    const Buffer* source = radiance ? coverage : normal ? sibling(trial, map + "normal") : nullptr;
    if (!coverage) return;
    const auto inBlock = [&](std::size_t i, std::size_t child) {
        const std::size_t column = i / 4 % b.shape[2], row = i / 4 / b.shape[2] % b.shape[1];
        return ((2 * row + (child >> 1)) * 2 * b.shape[2] + 2 * column + (child & 1)) * 4;
    };
    trial.suspect("divided by the number of covered texels of the 2x2 block, not by 4", [&](std::size_t i) {
        double covered = 0.0;
        for (std::size_t child = 0; child < 4; ++child) covered += decodedValue(*coverage, inBlock(i, child) + 3);
        return covered > 0.0 ? trial.expectedAt(i) * 4.0 / covered : trial.expectedAt(i);
    });
    if (!source) return;
    const auto isValue = [&](std::size_t i) { return i % 4 < 3; };
    trial.suspect("texels of other layers are not left out: the mean of the whole 2x2 block", [&](std::size_t i) {
        if (!isValue(i)) return trial.expectedAt(i);
        double sum = 0.0;
        for (std::size_t child = 0; child < 4; ++child) sum += decodedValue(*source, inBlock(i, child) + i % 4);
        // Where nothing is in the layer some programs store nothing.
        return trial.candidateAt(i) == 0.0 && trial.expectedAt(i) == 0.0 ? 0.0 : sum / 4.0;
    });
    for (std::size_t child = 0; child < 4; ++child)
        trial.suspect("texel " + std::to_string(child >> 1) + std::to_string(child & 1) + " of the 2x2 block, not the mean", [&](std::size_t i) {
            if (!isValue(i) || (trial.candidateAt(i) == 0.0 && trial.expectedAt(i) == 0.0)) return trial.expectedAt(i);
            return decodedValue(*source, inBlock(i, child) + i % 4);
        });
}

/// Sums of cones.
void suspectGather(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    const Buffer* cones = sibling(trial, "cones.diffuse");
    if (b.name != "cones.irradiance" || !cones || cones->shape.size() != 4) return;
    const std::size_t pixels = cones->shape[1] * cones->shape[2], count = cones->shape[0];
    const auto sum = [&](std::size_t i) {
        double total = 0.0;
        for (std::size_t cone = 0; cone < count; ++cone) total += decodedValue(*cones, (cone * pixels + i / 3) * 4 + i % 3);
        return total;
    };
    for (const auto& [factor, text] : {std::pair(double(kPi) / double(count), "all cones weigh the same (their weights differ)"),
                                       std::pair(1.0, "the plain sum of the cones, without weights and pi"),
                                       std::pair(1.0 / double(count), "the plain mean of the cones, without weights and pi")})
        trial.suspect(text, [&, factor = factor](std::size_t i) { return sum(i) * factor; });
}

}  // namespace

void suspectFormulas(HintTrial& trial)
{
    static const std::map<std::string, std::vector<void (*)(HintTrial&)>> families = {
        {"rsm", {suspectRsm}},           {"lrsm", {suspectLrsm, suspectBlock, suspectLayers}}, {"gbuffer", {suspectGBuffer}},
        {"direct", {suspectShading}},    {"cones", {suspectShading, suspectGather}},           {"filter", {suspectFilter, suspectShading}},
        {"composite", {suspectShading}}, {"vct cones", {suspectShading, suspectGather}},
    };
    if (const auto own = families.find(passFamily(trial.expected().pass)); own != families.end())
        for (const auto& suspect : own->second) suspect(trial);
}

}  // namespace lrsm
