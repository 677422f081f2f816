#include "apps/check/check_bundle.h"

#include "apps/check/check_report.h"
#include "apps/check/texel_inputs.h"
#include "apps/common/describe.h"
#include "core/imageio/display.h"
#include "core/imageio/image_io.h"
#include "core/report/html.h"
#include "core/report/table.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

constexpr std::size_t kShownInPage = 12;  ///< wrong buffers with pictures; all have files
constexpr int kSmallestSide = 256;        ///< smaller pictures are magnified
constexpr std::size_t kMostPixels = 1 << 22;

/// The two axes that make the picture, and where the others stand.
struct Slice {
    std::size_t row = 0, column = 0;  ///< axes
    std::vector<std::size_t> at;      ///< indices of the first difference
    int width = 0, height = 0;
    std::string title;
};

Slice sliceThrough(const Buffer& buffer, std::size_t element)
{
    Slice slice;
    slice.at = indicesOf(buffer, element);
    const std::vector<std::size_t> extents = extentsOf(buffer);
    const std::vector<std::string> names = axisNamesOf(buffer);
    const std::size_t axes = extents.size() - (buffer.components.empty() ? 0 : 1);
    if (axes < 2) return slice;
    slice.row = axes - 2;
    slice.column = axes - 1;
    if (extents[slice.row] * extents[slice.column] > kMostPixels) return slice;
    slice.height = static_cast<int>(extents[slice.row]);
    slice.width = static_cast<int>(extents[slice.column]);
    for (std::size_t axis = 0; axis < slice.row; ++axis) slice.title += ", " + names[axis] + " " + std::to_string(slice.at[axis]);
    return slice;
}

template <class Value>
Image<Vec3> sample(const Buffer& buffer, const Slice& slice, const Value& value)
{
    Image<Vec3> picture(slice.width, slice.height);
    const std::size_t channels = std::max<std::size_t>(buffer.components.size(), 1);
    std::vector<std::size_t> at = slice.at;
    for (int y = 0; y < slice.height; ++y)
        for (int x = 0; x < slice.width; ++x) {
            at[slice.row] = static_cast<std::size_t>(y);
            at[slice.column] = static_cast<std::size_t>(x);
            for (std::size_t c = 0; c < 3; ++c) {
                if (!buffer.components.empty()) at.back() = std::min(c, channels - 1);
                picture.at(x, y)[static_cast<int>(c)] = static_cast<float>(value(elementAt(buffer, at)));
            }
        }
    return picture;
}

/// How both sides are shown, decided by what is expected, so that they can be compared by eye.
Image<Rgb8> shown(const Buffer& buffer, const Image<Vec3>& picture, const Image<Vec3>& expected)
{
    const bool vectors = buffer.components.size() >= 3 && buffer.components[0] == "x";
    if (vectors && buffer.name.find("normal") != std::string::npos) return normalColor(picture);
    if (buffer.unit.starts_with("W/")) return tonemap(picture, automaticExposure(expected));
    if (buffer.components.size() >= 3 && !vectors) return tonemap(picture, 0.0f);
    Image<float> values(picture.width, picture.height);
    float low = kInfinity, high = -kInfinity;
    for (std::size_t i = 0; i < values.texels.size(); ++i) {
        values.texels[i] = picture.texels[i].x;
        if (!std::isfinite(expected.texels[i].x)) continue;
        low = std::min(low, expected.texels[i].x);
        high = std::max(high, expected.texels[i].x);
    }
    return falseColor(values, low < high ? low : 0.0f, low < high ? high : 1.0f);
}

Image<Rgb8> magnified(const Image<Rgb8>& picture)
{
    const int by = std::max(1, kSmallestSide / std::max(picture.width, picture.height));
    if (by == 1) return picture;
    Image<Rgb8> large(picture.width * by, picture.height * by);
    for (int y = 0; y < large.height; ++y)
        for (int x = 0; x < large.width; ++x) large.at(x, y) = picture.at(x / by, y / by);
    return large;
}

/// Largest difference of a texel's components, black where there is none.
Image<Rgb8> differencePicture(const Image<Vec3>& expected, const Image<Vec3>& actual)
{
    Image<float> size(expected.width, expected.height);
    float largest = 0.0f;
    for (std::size_t i = 0; i < size.texels.size(); ++i) {
        const Vec3 d = actual.texels[i] - expected.texels[i];
        size.texels[i] = std::max(std::abs(d.x), std::max(std::abs(d.y), std::abs(d.z)));
        if (std::isfinite(size.texels[i])) largest = std::max(largest, size.texels[i]);
    }
    return falseColor(size, 0.0f, largest > 0.0f ? largest : 1.0f);
}

std::vector<std::byte> differenceNpy(const CheckedBuffer& b)
{
    const Buffer& expected = b.expected();
    const bool voxels = expected.encoding == Encoding::bits;
    std::vector<float> values(valueCount(expected));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double c = b.candidate->given.empty() ? decodedValue(b.candidate->buffer, i) : b.candidate->given[i];
        values[i] = static_cast<float>(c - decodedValue(expected, i));
    }
    const std::vector<std::size_t> shape = voxels ? std::vector<std::size_t>{values.size()} : expected.shape;
    return encodeNpy(Dtype::f4, shape, std::as_bytes(std::span(values)));
}

/// Files of one wrong buffer; returns its pictures.
std::vector<ReportPicture> writeBuffer(OutputFolder& folder, const CheckedBuffer& b)
{
    const Buffer& expected = b.expected();
    folder.write(expected.name + ".expected.npy", encodeNpy(expected.dtype, expected.shape, expected.bytes));
    folder.write(expected.name + ".actual.npy", encodeNpy(expected.dtype, expected.shape, b.candidate->buffer.bytes));
    folder.write(expected.name + ".difference.npy", differenceNpy(b));
    const Slice slice = b.comparison().first ? sliceThrough(expected, b.comparison().first->element) : Slice();
    if (slice.width == 0) return {};
    const Image<Vec3> wanted = sample(expected, slice, [&](std::size_t i) { return decodedValue(expected, i); });
    const Image<Vec3> came = sample(expected, slice, [&](std::size_t i) { return decodedValue(b.candidate->buffer, i); });
    std::vector<ReportPicture> pictures = {{"expected" + slice.title, encodePng(magnified(shown(expected, wanted, wanted)))},
                                           {"actual" + slice.title, encodePng(magnified(shown(expected, came, wanted)))},
                                           {"difference" + slice.title, encodePng(magnified(differencePicture(wanted, came)))}};
    for (const ReportPicture& picture : pictures) folder.write(expected.name + "." + picture.title.substr(0, picture.title.find(',')) + ".png", picture.png);
    return pictures;
}

std::string listHtml(const std::vector<std::string>& lines)
{
    std::string html;
    for (const std::string& line : lines) html += "<li>" + htmlEscaped(line) + "</li>";
    return lines.empty() ? html : "<ul>" + html + "</ul>\n";
}

ReportTable inputsTable(const CheckedBuffer& b, const Capture& inputs)
{
    ReportTable table{"What this texel is computed from", {"input", "value"}, {}};
    for (const TexelInput& input : inputsOf(inputs, b.expected(), b.comparison().first->element)) table.rows.push_back({input.what, input.value});
    return table;
}

std::string sectionOf(const CheckedBuffer& b, const Capture& inputs, const std::vector<ReportPicture>& pictures)
{
    const Buffer& expected = b.expected();
    const BufferComparison& c = b.comparison();
    std::string html =
        headingHtml(expected.pass + ": " + expected.name) + paragraphHtml(expected.meaning + (expected.unit.empty() ? "" : ", " + expected.unit));
    html += paragraphHtml(c.why + ". Tolerance: " + toleranceText(expected.tolerance) + " (" + expected.tolerance.reason + ").");
    if (!b.where.empty()) html += paragraphHtml("Where: " + b.where + ".");
    html += listHtml(b.hints);
    if (!b.note.empty()) html += paragraphHtml("Note: " + b.note + ".");
    if (!pictures.empty()) {
        html += "<div class=\"row\">";
        for (const ReportPicture& picture : pictures)
            html += "<figure>" + pictureHtml(picture) + "<figcaption>" + htmlEscaped(picture.title) + "</figcaption></figure>";
        html += "</div>\n";
    }
    if (c.first) {
        ReportTable texel{"First difference: " + placeText(expected, c.first->element), {"side", "texel"}, {}};
        texel.rows.push_back({"expected", texelText(expected, c.first->element)});
        texel.rows.push_back({"candidate", texelText(b.candidate->buffer, c.first->element)});
        html += tableHtml(texel) + tableHtml(inputsTable(b, inputs));
    }
    return html;
}

constexpr std::string_view kBundleStyle =
    ".row { display: flex; flex-wrap: wrap; gap: 1em } .row img { width: 400px; max-width: 100%; image-rendering: pixelated } "
    "figcaption { text-align: center } td { text-align: left }";

}  // namespace

void writeCheck(OutputFolder& folder, const CheckReport& report, const Capture& inputs, const std::string& title)
{
    nlohmann::ordered_json json = checkJson(report);
    HtmlPage page{title, report.summary(), "", std::string(kBundleStyle), ""};
    page.bodyHtml += listHtml(report.notes);
    std::size_t shownInPage = 0, index = 0;
    std::string sections;
    for (const CheckedBuffer& b : report.buffers) {
        nlohmann::ordered_json& entry = json["buffers"][index++];
        if (b.verdict != Verdict::wrong) continue;
        const std::vector<ReportPicture> pictures = writeBuffer(folder, b);
        if (b.comparison().first)
            for (const TexelInput& input : inputsOf(inputs, b.expected(), b.comparison().first->element)) entry["first_inputs"][input.what] = input.value;
        if (shownInPage++ < kShownInPage) sections += sectionOf(b, inputs, pictures);
    }
    if (shownInPage > kShownInPage)
        sections += paragraphHtml(std::to_string(shownInPage - kShownInPage) + " more wrong buffers: see their files and check.json.");
    page.bodyHtml += sections + headingHtml("All buffers") + preformattedHtml(checkTable(report));
    folder.write("check.json", jsonText(json));
    folder.write("report.html", htmlPage(page));
}

}  // namespace lrsm
