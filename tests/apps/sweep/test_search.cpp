#include "apps/sweep/cases.h"
#include "apps/sweep/search.h"
#include "apps/sweep/search_grid.h"
#include "catch.h"
#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>

using namespace lrsm;

namespace {

std::vector<Axis> smallAxes()
{
    return {{"cone_count", {"1", "3", "6", "12", "24"}},
            {"voxel_resolution", {"128", "256", "512", "1024"}},
            {"rsm_resolution", {"256", "512", "1024", "2048"}},
            {"depth_layers", {"1", "2", "3"}}};
}
constexpr int kSmallGrid = 5 * 4 * 4 * 3;

/// Each axis adds to the cost and takes from an error of its own; the largest of these errors is nearly all that shows, as with a picture. Monotone,
/// with random steps; `roughness` breaks it.
class SyntheticSpace {
  public:
    SyntheticSpace(std::uint32_t seed, double roughness, std::size_t scenes = 1) : grid_({}, smallAxes()), roughness_(roughness), seed_(seed)
    {
        std::mt19937 random(seed);
        const auto uniform = [&random] { return double(random() % 1000) * 1e-3; };
        for (std::size_t scene = 0; scene < scenes; ++scene) {
            std::vector<std::vector<CostError>> axes;
            for (std::size_t axis = 0; axis < grid_.axisCount(); ++axis) {
                std::vector<CostError> values = {{0.2 + uniform(), 0.1 + 0.9 * uniform()}};
                while (int(values.size()) < grid_.valueCount(axis))
                    values.push_back({values.back().cost * (1.0 + 1.5 * uniform()), values.back().error * (0.4 + 0.6 * uniform())});
                axes.push_back(values);
            }
            axes_.push_back(axes);
        }
    }

    CostError at(const Settings& settings, std::size_t scene) const
    {
        const GridPosition position = grid_.nearest(settings);
        CostError value;
        std::uint32_t hash = seed_;
        for (std::size_t axis = 0; axis < position.size(); ++axis) {
            const CostError& part = axes_[scene][axis][std::size_t(position[axis])];
            value.cost += part.cost;
            value.error += std::pow(part.error, 6.0);
            hash = hash * 31u + std::uint32_t(position[axis]);
        }
        std::mt19937 rough(hash + std::uint32_t(scene));
        value.error = std::pow(value.error, 1.0 / 6.0) * std::exp(roughness_ * (double(rough() % 2001) * 1e-3 - 1.0));
        return value;
    }

    std::vector<CostError> bruteFront() const
    {
        std::vector<CostError> all;
        GridPosition position = grid_.first();
        do {
            std::vector<CostError> scenes;
            for (std::size_t scene = 0; scene < axes_.size(); ++scene) scenes.push_back(at(*grid_.at(position), scene));
            all.push_back(combineScenes(scenes));
        } while (grid_.advance(position));
        std::vector<CostError> front;
        for (const std::size_t i : paretoFront(all)) front.push_back(all[i]);
        return front;
    }

    SearchOptions options(int budget) const
    {
        SearchOptions options;
        options.budget = budget;
        options.sceneCount = axes_.size();
        options.evaluate = [this](const NamedSettings& named, std::size_t scene) { return at(named.settings, scene); };
        return options;
    }

  private:
    SettingsGrid grid_;
    std::vector<std::vector<std::vector<CostError>>> axes_;  ///< [scene][axis][value]
    double roughness_;
    std::uint32_t seed_;
};

std::vector<CostError> frontOf(const SearchResult& result)
{
    std::vector<CostError> front;
    for (const std::size_t i : result.front) front.push_back(result.points[i].value);
    return front;
}

bool sameFront(const std::vector<CostError>& a, const std::vector<CostError>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const CostError& x, const CostError& y) { return x.cost == y.cost && x.error == y.error; });
}

/// The largest factor by which a point of the true front is better, in both at once, than all that was found: 1 is perfect.
double worstLoss(const std::vector<CostError>& truth, const std::vector<CostError>& found)
{
    double worst = 1.0;
    for (const CostError& point : truth) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const CostError& other : found) nearest = std::min(nearest, std::max(other.cost / point.cost, other.error / point.error));
        worst = std::max(worst, nearest);
    }
    return worst;
}

}  // namespace

TEST_CASE("with the whole grid for a budget, the search visits each setting once and finds the exact front", "[sweep][search]")
{
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const SyntheticSpace space(seed, 0.05);
        const SearchResult result = runFrontSearch({}, smallAxes(), space.options(kSmallGrid + 1));
        CAPTURE(seed, result.visited);
        CHECK(result.exhausted);
        CHECK(result.visited == kSmallGrid);
        CHECK(sameFront(frontOf(result), space.bruteFront()));
        CHECK_FALSE(describeSearch(result).empty());
    }
}

TEST_CASE("half of the grid for a budget costs little, however rough the error", "[sweep][search]")
{
    double worst = 1.0;
    for (std::uint32_t seed = 40; seed < 48; ++seed) {
        const SyntheticSpace space(seed, 0.2);
        const SearchResult result = runFrontSearch({}, smallAxes(), space.options(120));
        CHECK(result.visited <= 120);
        worst = std::max(worst, worstLoss(space.bruteFront(), frontOf(result)));
    }
    CAPTURE(worst);
    CHECK(worst < 1.35);
}

TEST_CASE("a small budget comes near the front, and nearer than random drawing does", "[sweep][search]")
{
    double searched = 0.0, drawn = 0.0;
    for (std::uint32_t seed = 60; seed < 72; ++seed) {
        const SyntheticSpace space(seed, 0.02);
        const std::vector<CostError> truth = space.bruteFront();
        searched += std::log(worstLoss(truth, frontOf(runFrontSearch({}, smallAxes(), space.options(60)))));

        std::mt19937 random(seed);
        const SettingsGrid grid({}, smallAxes());
        std::vector<CostError> points;
        for (int i = 0; i < 60; ++i) {
            GridPosition position;
            for (std::size_t axis = 0; axis < grid.axisCount(); ++axis) position.push_back(int(random() % unsigned(grid.valueCount(axis))));
            points.push_back(space.at(*grid.at(position), 0));
        }
        drawn += std::log(worstLoss(truth, points));
    }
    CAPTURE(searched, drawn);
    CHECK(searched < 0.7 * drawn);
}

TEST_CASE("the search is a function of its seed and values, stopped and begun again, it ends at the same", "[sweep][search]")
{
    const SyntheticSpace space(7, 0.1, 3);
    const SearchOptions options = space.options(70);
    const SearchResult whole = runFrontSearch({}, smallAxes(), options);

    // Rows are stored per setting and scene; each run may render 25 new ones.
    std::map<std::string, CostError> store;
    SearchResult resumed;
    int runs = 0;
    do {
        int fresh = 0;
        SearchOptions part = options;
        part.evaluate = [&](const NamedSettings& named, std::size_t scene) -> std::optional<CostError> {
            const std::string key = named.label + "@" + std::to_string(scene);
            if (const auto found = store.find(key); found != store.end()) return found->second;
            if (fresh == 25) return {};
            ++fresh;
            return store[key] = space.at(named.settings, scene);
        };
        resumed = runFrontSearch({}, smallAxes(), part);
        REQUIRE(++runs < 50);
    } while (resumed.stopped);
    CHECK(runs > 2);
    CHECK(resumed.visited == whole.visited);
    CHECK(resumed.abandoned == whole.abandoned);
    REQUIRE(resumed.points.size() == whole.points.size());
    for (std::size_t i = 0; i < whole.points.size(); ++i) CHECK(resumed.points[i].settings == whole.points[i].settings);
}

TEST_CASE("what is far behind after some scenes is abandoned, and only that", "[sweep][search]")
{
    const SyntheticSpace space(9, 0.05, 4);
    SearchOptions options = space.options(120);
    int renders = 0;
    options.evaluate = [&](const NamedSettings& named, std::size_t scene) {
        ++renders;
        return space.at(named.settings, scene);
    };
    const SearchResult result = runFrontSearch({}, smallAxes(), options);
    CHECK(result.abandoned > 0);
    CHECK(result.visited == int(result.points.size()) + result.abandoned);
    CHECK(renders < result.visited * 4);
    for (const SearchPoint& point : result.points) CHECK(point.scenes.size() == 4);

    options.abandonMargin = std::numeric_limits<double>::infinity();
    CHECK(runFrontSearch({}, smallAxes(), options).abandoned == 0);
}

TEST_CASE("presets beside the grid take part, and what has no meaning is refused", "[sweep][search]")
{
    const SyntheticSpace space(3, 0.0);
    SearchOptions options = space.options(50);
    options.start = {{"literal", preset("literal")}, {"balanced", {}}};
    options.evaluate = [&](const NamedSettings& named, std::size_t) -> std::optional<CostError> {
        if (named.label == "literal") return CostError{0.1, 9.0};
        return space.at(named.settings, 0);
    };
    std::vector<Axis> axes = smallAxes();
    axes.push_back({"layer_overlap", {"0", "0.1"}});  // layer_selection=touched needs 0
    const SearchResult result = runFrontSearch({}, axes, options);
    CHECK(result.points.front().label == "literal");
    CHECK(result.front.front() == 0);
    CHECK(result.refused > 0);
    for (const SearchPoint& point : result.points) CHECK_NOTHROW(validate(point.settings));
    // The grid's origin is `balanced` and is not visited twice.
    int balanced = 0;
    for (const SearchPoint& point : result.points) balanced += point.settings == Settings{} ? 1 : 0;
    CHECK(balanced == 1);
}

TEST_CASE("scenes count alike: geometric means over each scene's baseline", "[sweep][search]")
{
    const CostError both = combineScenes(std::vector<CostError>{{2.0, 0.5}, {8.0, 2.0}});
    CHECK(both.cost == Approx(4.0));
    CHECK(both.error == Approx(1.0));
    CHECK(std::isnan(combineScenes(std::vector<CostError>{}).cost));

    Measurement a, b, baseA, baseB;
    baseA.cost = 10.0;
    baseB.cost = 1.0;
    a.cost = 5.0;
    b.cost = 2.0;
    baseA.error.rmse = 0.2;
    baseB.error.rmse = 0.4;
    a.error.rmse = 0.1;
    b.error.rmse = 0.1;
    const CostError value = combineScenes(std::vector<CostError>{relativeTo(a, baseA), relativeTo(b, baseB)});
    CHECK(value.cost == Approx(1.0));
    CHECK(value.error == Approx(std::sqrt(0.125)));
    // An exact picture has a ratio.
    a.error.rmse = 0.0;
    CHECK(relativeTo(a, baseA).error > 0.0);
}

TEST_CASE("options and axes out of range are refused", "[sweep][search]")
{
    const SyntheticSpace space(1, 0.0);
    const auto with = [&](auto change) {
        SearchOptions options = space.options(10);
        change(options);
        return options;
    };
    CHECK_THROWS_AS(runFrontSearch({}, smallAxes(), with([](SearchOptions& o) { o.budget = 0; })), InputError);
    CHECK_THROWS_AS(runFrontSearch({}, smallAxes(), with([](SearchOptions& o) { o.abandonMargin = 1.0; })), InputError);
    CHECK_THROWS_AS(runFrontSearch({}, {{"cone_count", {}}}, space.options(10)), InputError);
    CHECK_THROWS_AS(runFrontSearch({}, {{"cone_count", {"1"}}, {"cone_count", {"2"}}}, space.options(10)), InputError);
    CHECK_THROWS_AS(runFrontSearch({}, {{"cone_count", {"0"}}}, space.options(10)), InputError);
}
