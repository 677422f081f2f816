#include "core/base/text.h"

#include "catch.h"

using namespace lrsm;

TEST_CASE("Lists are joined and split", "[text]")
{
    CHECK(joined(std::vector<std::string>{}) == "");
    CHECK(joined(std::vector<std::string>{"a", "", "c"}) == "a, , c");
    CHECK(joined(
              std::vector<int>{1, 2}, [](int i) { return std::to_string(10 * i); }, " | ") == "10 | 20");
    CHECK(split("a, , c", ", ") == std::vector<std::string>{"a", "", "c"});
    CHECK(split("a", ",") == std::vector<std::string>{"a"});
    CHECK(split("", ",") == std::vector<std::string>{""});
    CHECK(split("a,", ",") == std::vector<std::string>{"a", ""});
}

TEST_CASE("The edit distance counts letters changed, added and dropped", "[text]")
{
    CHECK(editDistance("", "") == 0);
    CHECK(editDistance("", "abc") == 3);
    CHECK(editDistance("kitten", "sitting") == 3);
    CHECK(editDistance("sitting", "kitten") == 3);
    CHECK(editDistance("rsm0.depth", "rms0.depth") == 2);
}
