#pragma once

#include "apps/capture/capture_files.h"
#include "apps/capture/record.h"
#include "apps/capture/rerun.h"
#include "conetrace/render.h"
#include "core/base/output_folder.h"
#include "core/scene/builtin_scenes.h"

#include "catch.h"
#include "scratch.h"

#include <map>
#include <string>

namespace lrsm::test {

/// A frame small enough for a test, with everything in it.
inline Settings smallSettings()
{
    Settings s;
    s.voxel.resolution = 32;
    s.rsm.resolution = 64;
    s.direct.shadows = Shadows::hard;
    s.cones.set.filterPasses = 0;
    return s;
}

struct Recording {
    Scene scene;
    Settings settings;
    Requirements needs;
    RecordOptions options;
    Capture capture;
};

inline Recording record(const std::string& name, const Settings& settings, RecordOptions options = {})
{
    Recording r{*makeBuiltinScene(name), settings, {}, std::move(options), {}};
    r.options.width = 40;
    r.options.height = 30;
    r.needs = analyseRequirements(r.scene, settings.force);
    r.capture = recordCapture(r.scene, r.scene.cameras.at(0), r.needs, settings, r.options, "test");
    return r;
}

/// The capture that tests of candidates share: it is only read.
inline const Capture& sharedGolden()
{
    static const Capture capture = record("cornell-box", smallSettings()).capture;
    return capture;
}

/// Of each pass of the frame that renderFrame makes of the same.
inline std::map<std::string, std::string> renderedHashes(const Recording& r)
{
    RenderOptions options;
    options.width = r.options.width;
    options.height = r.options.height;
    std::map<std::string, std::string> hashes;
    for (const PassReport& pass : renderFrame(r.scene, r.scene.cameras.at(0), r.settings, options).passes) hashes[pass.name] = pass.sha256;
    return hashes;
}

inline std::map<std::string, std::string> hashesOf(const Capture& capture)
{
    std::map<std::string, std::string> hashes;
    for (const CapturedPass& pass : capture.passes) hashes[pass.name] = pass.sha256;
    return hashes;
}

inline Capture writtenAndRead(const Capture& capture, const ScratchFolder& scratch)
{
    OutputFolder folder(scratch.path("capture"));
    writeCapture(folder, capture);
    folder.commit();
    return readCapture(scratch.path("capture"));
}

/// Each pass, run on the capture's own buffers, makes its bytes again.
inline void checkRunsAnew(const Capture& capture)
{
    for (const CapturedPass& pass : capture.passes) {
        CAPTURE(pass.name);
        const Rerun rerun = rerunPass(capture, pass.name);
        CHECK(rerun.why.empty());
        for (const Buffer& made : rerun.outputs) {
            CAPTURE(made.name);
            CHECK(made.bytes == capture.at(made.name).bytes);
        }
    }
}

}  // namespace lrsm::test
