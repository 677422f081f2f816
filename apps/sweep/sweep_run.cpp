#include "apps/sweep/sweep_run.h"

#include "apps/common/memory.h"
#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/imageio/image_io.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>

namespace lrsm {

namespace fs = std::filesystem;

namespace {

constexpr int kThumbnailWidth = 160;
constexpr const char* kThumbnails = "thumbnails";

}  // namespace

Image<Vec3> shrink(const Image<Vec3>& picture, int width)
{
    if (picture.width <= width) return picture;
    const int height = std::max(1, picture.height * width / picture.width);
    Image<Vec3> small(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int x0 = x * picture.width / width, x1 = (x + 1) * picture.width / width;
            const int y0 = y * picture.height / height, y1 = (y + 1) * picture.height / height;
            Vec3 sum(0.0f);
            for (int v = y0; v < y1; ++v)
                for (int u = x0; u < x1; ++u) sum += picture.texels[picture.index(u, v)];
            small.texels[small.index(x, y)] = sum / static_cast<float>((x1 - x0) * (y1 - y0));
        }
    return small;
}

SweepRun::SweepRun(const std::vector<SweptCase>& cases, RowStore& store, const SweepRunOptions& options)
    : cases_(cases), store_(store), options_(options), progress_(options.quiet), begun_(std::chrono::steady_clock::now())
{
    fs::create_directories(fs::path(options_.folder) / kThumbnails);
    for (const SweptCase& one : cases_) writeThumbnail(one, one.key, one.scene.truth.irradiance);
}

void SweepRun::show(const SweptCase& sceneCase, const std::string& label, double fraction)
{
    // Rows take unlike times; the mean of those of this run is what is known.
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    const std::size_t done = measured_ + found_ + skipped_.size(), left = expected_ > done ? expected_ - done : 0;
    std::string time = "time left unknown";
    if (measured_ > 0) {
        const double each = elapsed / (double(measured_) + fraction), seconds = std::max(0.0, double(left) - fraction) * each;
        char text[48];
        std::snprintf(text, sizeof text, "%d:%02d:%02d left", int(seconds) / 3600, int(seconds) / 60 % 60, int(seconds) % 60);
        time = text;
    }
    progress_.show(
        "row " + std::to_string(done + 1) + " of " + std::to_string(std::max(expected_, done + 1)) + ", " + time + ": " + sceneCase.scene.name + " " + label,
        (double(done) + fraction) / double(std::max<std::size_t>(1, expected_)));
}

void SweepRun::writeThumbnail(const SweptCase& sceneCase, const std::string& key, const Image<Vec3>& irradiance) const
{
    const fs::path path = fs::path(options_.folder) / kThumbnails / (key + ".png");
    writeFileWhole(path.string(), encodePng(tonemap(shrink(irradiance, kThumbnailWidth), sceneCase.figures.exposureStops)));
}

void SweepRun::keep(const SweptCase& sceneCase, const Measured& measured)
{
    // The picture first: every row that is there has one.
    writeThumbnail(sceneCase, measured.row.key, measured.irradiance);
    store_.add(measured.row);
    ++measured_;
}

const Measurement* SweepRun::measure(const SweepTask& task)
{
    const SweptCase& one = cases_.at(task.sceneCase);
    const std::string key = rowKeyOf(one.key, task.named.settings);
    if (const Measurement* row = store_.find(key)) {
        ++found_;
        return row;
    }
    if (stopped()) return nullptr;
    show(one, task.named.label, 0.0);
    const auto skip = [&](const std::string& why) {
        progress_.clear();
        skipped_.push_back(one.scene.name + " " + task.named.label + ": " + why);
        if (!options_.quiet) std::cerr << "lrsm: skipped " << skipped_.back() << std::endl;
        return nullptr;
    };
    try {
        const Requirements needs = analyseRequirements(one.scene.scene, task.named.settings.force);
        enforceMemoryLimit({one.scene.scene, needs, task.named.settings, one.scene.width, one.scene.height}, options_.maxMemoryMegabytes);
        MeasureOptions options{.repeat = options_.repeat, .progress = [&](double fraction) { show(one, task.named.label, fraction); }};
        Measured measured = measureSettings(one.scene, one.figures, task.named.settings, calibration_, options);
        measured.row.label = task.named.label;
        measured.row.kind = task.kind;
        measured.row.base = task.base;
        keep(one, measured);
    } catch (const InputError& error) {
        return skip(error.what());
    } catch (const std::bad_alloc&) {
        return skip("there is not enough memory");
    }
    return store_.find(key);
}

bool SweepRun::measurePathTracer(std::size_t sceneCase, std::uint64_t samples)
{
    const SweptCase& one = cases_.at(sceneCase);
    std::size_t rows = 0, there = 0;
    for (std::uint64_t n = 1, before = 0; before < samples; before = n, n = std::min(2 * n, samples)) {
        ++rows;
        there += store_.find(rowKeyOf(one.key, n)) != nullptr;
    }
    found_ += there;
    if (there == rows) return true;
    if (stopped()) return false;
    // One run makes them all: what is there is traced again, and not added again.
    const MeasureOptions options{.progress = [&](double fraction) { show(one, "path tracer", fraction); }, .stop = options_.stop};
    lrsm::measurePathTracer(one.scene, one.figures, samples, calibration_, options, [&](const Measured& measured) {
        if (!store_.find(measured.row.key)) keep(one, measured);
    });
    return !stopped();
}

}  // namespace lrsm
