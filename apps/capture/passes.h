#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "apps/capture/rerun.h"
#include "conetrace/render.h"

/// All that captures and checks know of the passes is one table: a new method's passes are rows of passes.cpp.
namespace lrsm {

/// One family of passes: "voxel mips", or "rsm" with a pass a light ("rsm 0", "rsm 1", ...).
struct PassRow {
    std::string family;
    bool perLight = false;
    bool given = false;                                  ///< an input of the frame, no pass of it: never recorded from one, never run
    std::vector<std::string> stages = {};                ///< of the settings that it is tried with when a candidate is wrong (SettingInfo::stage)
    bool specular = false;                               ///< only frames of scenes with a specular part have it
    bool (*exists)(const Settings& settings) = nullptr;  ///< has a frame by these settings the pass? nullptr: every one has
    /// Families that it reads, where they exist. Of one with a pass a light: its own light's if it has a light itself, else all.
    std::vector<std::string> reads = {};
    std::vector<std::string> (*readsBesides)(const Settings& settings) = nullptr;
    /// Adds its buffers, empty.
    void (*describe)(Catalogue& out, const DescribedFrame& frame, std::size_t light) = nullptr;
    /// Fills them in, and what the capture holds besides, from what the frame shows under the pass's name.
    void (*record)(const PassOutput& output, std::size_t light, Capture& capture) = nullptr;
    /// The same from the finished frame, for what no pass shows.
    void (*recordFrame)(const Frame& frame, Capture& capture) = nullptr;
    /// How it is run anew: fills in `made.outputs` with what our pass makes of the capture. InputError naming what is not in it; what is made in part says why.
    void (*rerun)(const Capture& inputs, std::size_t light, Rerun& made) = nullptr;
    /// The same by other settings; of a pass with mips the base level alone. For maps, whose storage rounds: nullptr for others.
    void (*makeMap)(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs) = nullptr;
    /// Buffers whose texel of the same row and column a texel is made from; '#' stands for the light.
    std::vector<std::string> sameTexel = {};
};

/// In the order in which a capture holds their buffers: that of the data flow, but for lights, whose passes stand together.
const std::vector<PassRow>& passRows();
/// The row of "rsm 0"; nullptr when there is none.
const PassRow* findPassRow(const std::string& pass);
bool isGiven(const std::string& pass);
bool existsIn(const PassRow& row, const Settings& settings, const Requirements& needs);

/// "lrsm 1" -> 1; 0 without a number.
std::size_t lightOfPass(const std::string& pass);
/// How halves of the pass's buffers are rounded.
HalfRounding halfRoundingOf(const Settings& settings, const std::string& pass);

/// Passes that a pass reads, "scene" and "tables" among them.
std::vector<std::string> inputsOf(const std::string& pass, const Settings& settings, const Requirements& needs, std::size_t lights);

/// As on a command line: is `pass` one of those asked for, or is none asked for? "voxel-mips" is "voxel mips", "lrsm0" is "lrsm 0", "lrsm" every light's.
bool isAskedFor(const std::vector<std::string>& asked, const std::string& pass);
/// "voxelize, voxel-mips, ...", as they may be asked for; `ofLights` stands behind the first run of those with a pass a light.
std::string passNames(const std::string& ofLights = "");

/// Why `asked` is no pass to ask for, with a list of those that are; "" where it is one. For a command line's check.
std::string passNameError(const std::string& asked);

/// Every buffer of a frame, described but empty: names, shapes, meanings, tolerances.
std::vector<Buffer> describeBuffers(const DescribedFrame& frame);

}  // namespace lrsm
