#include "core/base/rng.h"

#include "catch.h"

using namespace lrsm;

TEST_CASE("Philox4x32-10 gives the published test vectors", "[core][rng]")
{
    // kat_vectors of Random123, the authors' own library.
    CHECK(philox({0, 0, 0, 0}, {0, 0}) == Philox4{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u});
    CHECK(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}) == Philox4{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu});
    CHECK(philox({0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}, {0xa4093822u, 0x299f31d0u}) ==
          Philox4{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u});
}

TEST_CASE("unit floats reach 0, never 1, and step by 2^-24", "[core][rng]")
{
    CHECK(unitFloat(0) == 0.0f);
    CHECK(unitFloat(~0u) == 1.0f - 0x1p-24f);
    CHECK(unitFloat(0x80000000u) == 0.5f);
    CHECK(unitFloat(0x1ffu) == 0x1p-24f);
}
