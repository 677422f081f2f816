#pragma once

#include "apps/capture/buffer.h"
#include "core/report/table.h"

#include <optional>

/// One buffer against another of the same description, element by element, as the golden's Tolerance says.
namespace lrsm {

/// Where an element is, for people: "layer 1, row 3, column 7, component 'z2'"; voxels by their own coordinates.
std::string placeText(const Buffer& description, std::size_t element);
/// Index along each axis of `description.axes` (the component's included); of a voxel: z, y, x.
std::vector<std::size_t> indicesOf(const Buffer& description, std::size_t element);
/// The inverse.
std::size_t elementAt(const Buffer& description, std::span<const std::size_t> indices);
/// The extents that go with indicesOf, and their names: those of the shape, or voxels along z, y and x.
std::vector<std::size_t> extentsOf(const Buffer& description);
std::vector<std::string> axisNamesOf(const Buffer& description);

/// Elements that a capture does not use (components without a name) are not compared.
bool compared(const Buffer& description, std::size_t element);

/// Position of a value on the ruler of the buffer's storage: codes of a UNORM, representable halves, floats or doubles in their order, counted
/// from 0; between two of them in proportion. NaN gives NaN.
double ordinalOf(const Buffer& description, double value);

struct ElementDifference {
    std::size_t element = 0;
    double golden = 0.0, candidate = 0.0;
    double size = 0.0;  ///< in the tolerance's unit: ULP, decoded value, or share of max(|golden|, floor). Exact: decoded value
};

struct BufferComparison {
    std::size_t elements = 0;                ///< compared
    std::size_t live = 0;                    ///< not 0 in both: what the tolerance's fractions are of
    std::size_t differing = 0;               ///< other bits; +0 and -0 are the same number unless the tolerance is exact
    std::size_t outside = 0;                 ///< beyond the tolerance, NaN included
    std::size_t notANumber = 0;              ///< NaN in the candidate alone, in the golden alone, or in both with other bits: never excused
    std::optional<ElementDifference> first;  ///< in memory order: outside the tolerance, or else merely differing
    std::optional<ElementDifference> worst;
    bool holds = true;
    std::string why;  ///< of a failure: "412 of 16384 outside (2.5 %, 0.5 % allowed)"
};

/// `candidate` has the golden's description. `given`, when not empty, holds the values as the candidate's file had them (in another element type),
/// one an element: differences are measured with them.
BufferComparison compareBuffers(const Buffer& golden, const Buffer& candidate, std::span<const double> given = {});

/// "exact", "1 ULP", "0.001", "2 % of max(|golden|, 0.01)", and the fraction of outliers.
std::string toleranceText(const Tolerance& tolerance);
/// "13 ULP", "2.1e-4", "4.1 %": a difference's size with its unit.
std::string sizeText(const Buffer& golden, double size);

}  // namespace lrsm
