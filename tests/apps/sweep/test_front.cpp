#include "apps/sweep/front.h"
#include "catch.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>

using namespace lrsm;

namespace {

/// Few different values, so that ties are common.
std::vector<CostError> randomPoints(std::mt19937& random, std::size_t count)
{
    std::vector<CostError> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({double(1 + random() % 9), 0.5 + double(random() % 9)});
    return points;
}

bool beats(const CostError& a, const CostError& b)
{
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

}  // namespace

TEST_CASE("the front is what no point beats, by definition, of equal points the first", "[sweep][front]")
{
    std::mt19937 random(1);
    for (int round = 0; round < 500; ++round) {
        std::vector<CostError> points = randomPoints(random, random() % 30);
        if (round % 5 == 0 && !points.empty()) points[random() % points.size()].error = std::numeric_limits<double>::quiet_NaN();
        const std::vector<std::size_t> found = paretoFront(points);
        std::set<std::size_t> expected;
        for (std::size_t i = 0; i < points.size(); ++i) {
            bool stays = !std::isnan(points[i].error);
            for (std::size_t j = 0; j < points.size(); ++j)
                if (beats(points[j], points[i]) || (j < i && points[j].cost == points[i].cost && points[j].error == points[i].error)) stays = false;
            if (stays) expected.insert(i);
        }
        CHECK(std::set<std::size_t>(found.begin(), found.end()) == expected);
        CHECK(found.size() == expected.size());
        for (std::size_t i = 1; i < found.size(); ++i) {
            CHECK(points[found[i - 1]].cost < points[found[i]].cost);
            CHECK(points[found[i - 1]].error > points[found[i]].error);
        }
    }
}

TEST_CASE("a power law is read back exactly between its points, in both directions", "[sweep][front]")
{
    const auto errorOf = [](double cost) { return 3.0 * std::pow(cost, -0.7); };
    std::vector<CostError> curve;
    for (const double cost : {0.5, 1.0, 3.0, 10.0}) curve.push_back({cost, errorOf(cost)});
    for (double cost = 0.5; cost < 10.0; cost *= 1.1) {
        CHECK(errorAtCost(curve, cost).value() == Approx(errorOf(cost)));
        CHECK(costAtError(curve, errorOf(cost)).value() == Approx(cost));
    }
}

TEST_CASE("a curve ends where its points end", "[sweep][front]")
{
    const std::vector<CostError> curve = {{1.0, 0.4}, {2.0, 0.2}};
    CHECK(costAtError(curve, 0.9).value() == 1.0);  // the cheapest point does already
    CHECK(costAtError(curve, 0.2).value() == 2.0);
    CHECK_FALSE(costAtError(curve, 0.19));
    CHECK_FALSE(errorAtCost(curve, 0.99));
    CHECK(errorAtCost(curve, 1.0).value() == 0.4);
    CHECK(errorAtCost(curve, 1e9).value() == 0.2);
    CHECK_FALSE(errorAtCost({}, 1.0));
    CHECK_FALSE(costAtError({}, 1.0));
    CHECK_FALSE(costAtError(curve, std::numeric_limits<double>::quiet_NaN()));
    CHECK_FALSE(errorAtCost(curve, std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("an exact picture and equal costs do not make NaNs", "[sweep][front]")
{
    const std::vector<CostError> curve = {{1.0, 0.4}, {1.0, 0.3}, {2.0, 0.0}};
    CHECK(errorAtCost(curve, 1.0).value() == 0.3);
    CHECK(errorAtCost(curve, 1.5).value() == 0.3);  // no logarithm of 0: what has been reached
    CHECK(costAtError(curve, 0.1).value() == 2.0);
    CHECK(costAtError(curve, 0.35).value() == Approx(1.0));
}

TEST_CASE("of a curve that turns back, the first crossing counts", "[sweep][front]")
{
    const std::vector<CostError> curve = {{1.0, 0.4}, {2.0, 0.2}, {4.0, 0.3}, {8.0, 0.1}};
    CHECK(costAtError(curve, 0.25).value() < 2.0);
    CHECK(costAtError(curve, 0.15).value() > 4.0);
    CHECK(errorAtCost(curve, 4.0).value() == 0.3);
}
