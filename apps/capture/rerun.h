#pragma once

#include "apps/capture/capture.h"

#include <optional>

/// A pass of ours run anew on what is in a capture, so that a pass can be judged by its own inputs.
namespace lrsm {

struct Rerun {
    std::vector<Buffer> outputs;  ///< those buffers of the pass that `inputs` has, with the bytes that our pass makes
    std::string why;              ///< of what could not be made: "rsm0.depth is not in the capture"; empty: all was
};

/// What `pass` ("voxel mips", "lrsm 0", "direct", "cones", "filter", "composite", ...) makes of the buffers in `inputs`.
///
/// Mip chains level by level: each from the level below as it is in `inputs`, so that a wrong level does not make those above it wrong. LRSMs
/// with the capture's layer ranges, not ranges fitted to the RSM in it.
/// "voxelize", "rsm i" and "gbuffer" read the scene, which must be whole (Capture::sceneComplete).
Rerun rerunPass(const Capture& inputs, const std::string& pass);

/// One output of "rsm i", of "vct inject" or of the base level of "lrsm i" as float32, before it is converted to its storage. Nothing where that cannot be had.
std::optional<Buffer> wideOutput(const Capture& inputs, const std::string& buffer);

/// The maps of all lights.
template <class Map>
std::vector<Map> mapsOf(const Capture& inputs, Map (*fromCapture)(const Capture&, std::size_t))
{
    std::vector<Map> maps;
    for (std::size_t light = 0; light < inputs.lights.size(); ++light) maps.push_back(fromCapture(inputs, light));
    return maps;
}
/// InputError where it is not all in the capture.
Scene wholeScene(const Capture& inputs);

// The passes' own, for their rows (passes.h).
void rerunVoxelize(const Capture& inputs, std::size_t light, Rerun& made);
void rerunVoxelMips(const Capture& inputs, std::size_t light, Rerun& made);
void makeRsm(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs);
void makeLrsmBase(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs);
void rerunShadow(const Capture& inputs, std::size_t light, Rerun& made);
void rerunLrsm(const Capture& inputs, std::size_t light, Rerun& made);
void rerunGBuffer(const Capture& inputs, std::size_t light, Rerun& made);
void rerunDirect(const Capture& inputs, std::size_t light, Rerun& made);
void rerunCones(const Capture& inputs, std::size_t light, Rerun& made);
void rerunVctSurface(const Capture& inputs, std::size_t light, Rerun& made);
void makeVctBase(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs);
void rerunVctMips(const Capture& inputs, std::size_t light, Rerun& made);
void rerunVctCones(const Capture& inputs, std::size_t light, Rerun& made);
void makeLitVoxels(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs);
void rerunVoxelRadiance(const Capture& inputs, std::size_t light, Rerun& made);
void rerunClusters(const Capture& inputs, std::size_t light, Rerun& made);
void rerunPlaces(const Capture& inputs, std::size_t light, Rerun& made);
void rerunFill(const Capture& inputs, std::size_t light, Rerun& made);
void rerunConvolve(const Capture& inputs, std::size_t light, Rerun& made);
void rerunCachedLight(const Capture& inputs, std::size_t light, Rerun& made);
void rerunProxies(const Capture& inputs, std::size_t light, Rerun& made);
void rerunProxyLight(const Capture& inputs, std::size_t light, Rerun& made);
void rerunProxyCells(const Capture& inputs, std::size_t light, Rerun& made);
void rerunProxyMarch(const Capture& inputs, std::size_t light, Rerun& made);
void rerunProxyFilter(const Capture& inputs, std::size_t light, Rerun& made);
void rerunWeighProxies(const Capture& inputs, std::size_t light, Rerun& made);
void rerunProxyGather(const Capture& inputs, std::size_t light, Rerun& made);
void rerunIsmLights(const Capture& inputs, std::size_t light, Rerun& made);
void rerunIsmMaps(const Capture& inputs, std::size_t light, Rerun& made);
void rerunIsmGather(const Capture& inputs, std::size_t light, Rerun& made);
void rerunFilter(const Capture& inputs, std::size_t light, Rerun& made);
void rerunSpecularFilter(const Capture& inputs, std::size_t light, Rerun& made);
void rerunSmooth(const Capture& inputs, std::size_t light, Rerun& made);
void rerunComposite(const Capture& inputs, std::size_t light, Rerun& made);

}  // namespace lrsm
