#include "core/scene/cut_polygon.h"

namespace lrsm {

CutPolygon cut(const CutPolygon& in, int axis, double sign, double bound)
{
    CutPolygon out;
    for (std::size_t k = 0; k < in.count; ++k) {
        const glm::dvec3 &p = in.corner[k], &q = in.corner[(k + 1) % in.count];
        const double dp = sign * (p[axis] - bound), dq = sign * (q[axis] - bound);
        if (dp <= 0.0) out.push(p);
        if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) out.push(p + (q - p) * (dp / (dp - dq)));
    }
    return out;
}

}  // namespace lrsm
