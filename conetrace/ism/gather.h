#pragma once

#include "conetrace/ism/evaluate.h"

/// method = ism, [ISM]: Ritschel et al. 2008, as the paper on point proxies compares itself with it. Virtual lights are drawn from the lights' maps, a small
/// depth map of each is made of points, and every pixel takes all lights, or a 16th of them and what its neighbours take of the others.
namespace lrsm {

struct ImperfectLights {
    VirtualLights lights;
    ImperfectMaps maps;
};
/// The passes "pp place", "ism lights" and "ism maps".
ImperfectLights buildImperfectLights(const GatherInput& input, PassLog& log);

/// The passes above and "ism gather".
Gathered gatherIsm(const GatherInput& input, PassLog& log);

/// The line of the frame's switch.
GatherMethod ismMethod();

}  // namespace lrsm
