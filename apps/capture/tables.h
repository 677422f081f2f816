#pragma once

#include "apps/capture/catalogue.h"
#include "conetrace/frame/gather_plan.h"
#include "lrsm/gaussian_visibility.h"

namespace lrsm {

struct Table {
    std::string name;
    Dtype dtype = Dtype::f4;
    std::vector<std::size_t> shape;  ///< empty: this frame does not use it
    std::vector<std::byte> bytes;
};

/// What a frame works out once from its settings, as arrays: pass "tables".
struct CaptureTables {
    GatherPlan plan;
    NormalCdf phi;
    Table directions, rotation, schedules, steps, gaussian, specularAlbedo, lobePoints, cosineShare, solidAngle;

    std::vector<const Table*> all() const
    {
        return {&directions, &rotation, &schedules, &steps, &gaussian, &specularAlbedo, &lobePoints, &cosineShare, &solidAngle};
    }
};
CaptureTables makeTables(const Requirements& needs, const Settings& settings);

void describeTables(Catalogue& out, const DescribedFrame& frame, std::size_t light);

}  // namespace lrsm
