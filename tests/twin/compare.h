#pragma once

#include "tests/twin/frame.h"

namespace lrsm::twin {

/// How an output compares with the golden's buffer, element by element.
struct Difference {
    std::string name, pass, kind;  ///< of the tolerance
    double value = 0.0;
    std::size_t elements = 0;                             ///< that are not 0 in both
    std::size_t differing = 0;                            ///< of those, not the same bits
    std::size_t outside = 0;                              ///< of those, beyond the tolerance
    double largest = 0.0;                                 ///< in the tolerance's unit
    double allowedOutside = 0.0, allowedDiffering = 1.0;  ///< fractions
    bool accepted() const { return double(outside) <= allowedOutside * double(elements) && double(differing) <= allowedDiffering * double(elements); }
};

/// Every output of the frame, in the manifest's order.
std::vector<Difference> differences(const Frame& frame);

}  // namespace lrsm::twin
