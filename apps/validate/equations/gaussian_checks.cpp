// Eq. 12: the normal distribution by table, polynomial and in double, and the fraction of it that a cone sample's window holds.
#include "lrsm/gaussian_visibility.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/oracle.h"

namespace lrsm {
namespace {

std::string nameOf(GaussianMethod method, int tableSize)
{
    if (method == GaussianMethod::table) return "table(" + std::to_string(tableSize) + ")";
    return method == GaussianMethod::polynomial ? "polynomial" : "exact";
}

/// The search runs against erfc in long double; its winner is measured once more to 50 digits.
void checkPhi(CheckRun& run, GaussianMethod method, int tableSize, const char* boundName)
{
    const NormalCdf phi(method, tableSize);
    SearchSpace<float, 1> space{{{{-40.0f, 40.0f}}}, {{0.0f}, {-5.0f}, {5.0f}, {-5.25f}, {5.25f}, {2.5f}, {-2.5f}, {-1e30f}, {1e30f}, {1e-38f}, {-1e-38f}}};
    space.axes[0] = {-40.0f, 40.0f};
    if (method == GaussianMethod::table)
        for (int i = 0; i < std::min(tableSize, 4096); ++i) space.planted.push_back({static_cast<float>(-5.0 + 10.0 * i / (tableSize - 1))});
    const auto error = [&](const std::array<float, 1>& in) {
        return std::abs(static_cast<double>(static_cast<long double>(phi(in[0])) - oracle::phi(static_cast<long double>(in[0]))));
    };
    auto worst = findWorst(space, {run.scaled(60000), run.scaled(60000)}, error, 301);
    space.axes[0] = {-6.0f, 6.0f};  // where something happens
    worst.include(findWorst(space, {run.scaled(120000), run.scaled(120000)}, error, 302));
    worst.error = std::abs(oracle::phiError(double(worst.input[0]), double(phi(worst.input[0]))));
    run.add({.equation = "12",
             .function = "NormalCdf, " + nameOf(method, tableSize),
             .oracle = "50-digit erfc (Boost.Multiprecision)",
             .domain = "any x; searched in [-40, 40]",
             .bound = {boundName, double(phi.maxError())},
             .nanoseconds = run.time(4096, [&](std::size_t i) { return phi(-6.0f + 12.0f * float(i) / 4096.0f); })},
            worst, inputText<float, 1>({"x"}, worst.input));
}

/// The table against straight lines between exact nodes: what is left is rounding alone, whatever the table's size.
void checkTableNodes(CheckRun& run)
{
    Worst<float, 1> worst;
    std::string at;
    for (const int entries : {2, 3, 11, 64, 129, 1024, 4096}) {
        const NormalCdf phi(GaussianMethod::table, entries);
        SearchSpace<float, 1> space{{{{-5.5f, 5.5f}}}, {{-5.0f}, {5.0f}}};
        for (int i = 0; i < entries; ++i) space.planted.push_back({static_cast<float>(-5.0 + 10.0 * i / (entries - 1))});
        const auto found = findWorst(
            space, run.budget(20000),
            [&](const std::array<float, 1>& in) {
                const long double x = static_cast<long double>(in[0]), cell = 10.0L / (entries - 1);
                long double expected = x <= -5.0L ? 0.0L : 1.0L;
                if (x > -5.0L && x < 5.0L) {
                    const long double i = std::min(std::floor((x + 5.0L) / cell), static_cast<long double>(entries - 2)), left = -5.0L + i * cell;
                    expected = oracle::phi(left) + (x - left) / cell * (oracle::phi(left + cell) - oracle::phi(left));
                }
                return std::abs(static_cast<double>(static_cast<long double>(phi(in[0])) - expected));
            },
            303);
        if (found.error > worst.error) at = "entries = " + std::to_string(entries) + ", x = " + exactText(found.input[0]);
        worst.include(found);
    }
    run.add({.equation = "12",
             .function = "NormalCdf, table, against its own straight lines",
             .oracle = "interpolation of erfc's values in long double",
             .domain = "tables of 2 .. 4096 entries over [-5, 5], every node",
             .bound = {"kTableCdfRoundingError", double(kTableCdfRoundingError)}},
            worst, at);
}

void checkExactDouble(CheckRun& run)
{
    const SearchSpace<double, 1> space{{{{-38.5, 9.0}}}, {{2.5}, {-2.5}, {0.0}, {-8.0}}};
    auto worst = findWorst(
        space, run.budget(4000), [](const auto& in) { return std::abs(oracle::phiError(in[0], normalCdfExact(in[0]))); }, 304);
    run.add({.equation = "12",
             .function = "normalCdfExact",
             .oracle = "50-digit erfc (Boost.Multiprecision)",
             .domain = "any x; searched in [-38.5, 9]",
             .bound = {"kExactDoubleCdfMaxError", kExactDoubleCdfMaxError},
             .nanoseconds = run.time(1024, [](std::size_t i) { return normalCdfExact(-6.0 + 12.0 * double(i) / 1024.0); })},
            worst, inputText<double, 1>({"x"}, worst.input));
    const SearchSpace<double, 1> tail{{{{-37.0, 0.0}}}, {{-2.5}, {-37.0}}};
    worst = findWorst(
        tail, run.budget(2500), [](const auto& in) { return std::abs(oracle::phiRelativeError(in[0], normalCdfExact(in[0]))); }, 305);
    run.add({.equation = "12",
             .function = "normalCdfExact, lower tail",
             .oracle = "50-digit erfc (Boost.Multiprecision)",
             .domain = "[-37, 0]",
             .errorKind = "relative",
             .bound = {"kExactDoubleCdfMaxRelativeError", kExactDoubleCdfMaxRelativeError}},
            worst, inputText<double, 1>({"x"}, worst.input));
}

double visibilityError(const NormalCdf& phi, const Window& w, float v)
{
    if (!(v >= 0.0f && v <= 1.0f)) return std::numeric_limits<double>::infinity();
    (void)phi;
    return std::abs(static_cast<double>(static_cast<long double>(v) - oracle::visibility(w.mu, w.sigma2, w.zc, w.rc)));
}

/// Error and time of one choice; the same rows make the trade and its curves.
EquationTrade checkVisibility(CheckRun& run, GaussianMethod method, int tableSize, bool addRow, const NamedBound& bound)
{
    const NormalCdf phi(method, tableSize);
    const auto error = [&](const std::array<float, 4>& in) {
        const Window w = windowOf(in);
        return visibilityError(phi, w, gaussianVisibility(phi, w.mu, w.sigma2, w.zc, w.rc));
    };
    auto worst = findWorst(windowSpace(0x1p-24f), run.budget(60000), error, 306);
    const Window at = windowOf(worst.input);
    worst.error = std::abs(oracle::visibilityError(at.mu, at.sigma2, at.zc, at.rc, double(gaussianVisibility(phi, at.mu, at.sigma2, at.zc, at.rc))));

    EquationTrade trade{.setting = "gaussian",
                        .choice = nameOf(method, tableSize),
                        .quantity = "V, Eq. 12",
                        .bound = bound.value,
                        .worst = worst.error,
                        .meanError = worst.mean()};
    trade.bytes = method == GaussianMethod::table ? std::size_t(tableSize) * sizeof(float) : 0;
    // Bias and time over the windows that cones have: sigma and radius of like size.
    std::vector<Window> usual(4096);
    SearchRandom random(307);
    for (Window& w : usual) {
        const float sigma = random.uniform(0.005f, 0.2f), rc = random.uniform(0.01f, 0.3f);
        w = {random.uniform(0.2f, 0.8f), sigma * sigma, random.uniform(0.0f, 1.0f), rc};
        trade.bias += (double(gaussianVisibility(phi, w.mu, w.sigma2, w.zc, w.rc)) - static_cast<double>(oracle::visibility(w.mu, w.sigma2, w.zc, w.rc))) /
                      double(usual.size());
    }
    trade.nanoseconds = run.time(usual.size(), [&](std::size_t i) { return gaussianVisibility(phi, usual[i].mu, usual[i].sigma2, usual[i].zc, usual[i].rc); });
    if (addRow)
        run.add({.equation = "12",
                 .function = "gaussianVisibility, " + trade.choice,
                 .oracle = "50-digit erfc (Boost.Multiprecision)",
                 .domain = "mu in [0, 1], sigma 2^-24 .. 1, r_c 2^-20 .. 2, an end of the window within 9 sigma of mu",
                 .bound = bound,
                 .nanoseconds = trade.nanoseconds},
                worst, inputText<float, 4>({"mu", "sigma2", "zc", "rc"}, {at.mu, at.sigma2, at.zc, at.rc}));
    run.add(trade);
    return trade;
}

/// Zero and negative variance: a step, 1/2 on its edge; NaN stays NaN.
void checkStep(CheckRun& run)
{
    constexpr GaussianMethod kMethods[3] = {GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact};
    const auto wrong = exhaust(3 * 3 * 2 * 5, [&](std::uint64_t i) {
        const NormalCdf phi(kMethods[i % 3], 256);
        constexpr float kVariances[3] = {0.0f, -0.0f, -1e-3f};
        const float sigma2 = kVariances[i / 3 % 3], zc = i / 9 % 2 ? 0.25f : 0.75f;
        const int ulps = static_cast<int>(i / 18) - 2;
        const float v = gaussianVisibility(phi, 0.5f, sigma2, zc, moveByUlps(0.25f, ulps));
        return v == (ulps < 0 ? 0.0f : ulps > 0 ? 1.0f : 0.5f) ? 0.0 : 1.0;
    });
    run.add(exactCheck("12", "gaussianVisibility, variance <= 0", "Heaviside, 1/2 on the edge", "r_c within 2 ULP of |z_c - mu|"), wrong,
            "case " + exactText(wrong.input[0]));
}

void addCurves(CheckRun& run, const std::vector<EquationTrade>& tables)
{
    ChartSeries measured{.label = "measured"}, bound{.label = "bound"};
    for (const EquationTrade& trade : tables) {
        const double entries = double(trade.bytes) / sizeof(float);
        measured.x.push_back(entries), measured.y.push_back(trade.worst);
        bound.x.push_back(entries), bound.y.push_back(trade.bound);
    }
    run.add({"12",
             {.title = "Eq. 12 by table: error against size",
              .xLabel = "entries",
              .yLabel = "largest error of V",
              .logX = true,
              .logY = true,
              .series = {measured, bound}}});

    Chart byX{.title = "error of Phi against x", .xLabel = "x", .yLabel = "|error|", .logX = false, .logY = true};
    const NormalCdf choices[4] = {NormalCdf(GaussianMethod::table, 64), NormalCdf(GaussianMethod::table, 1024), NormalCdf(GaussianMethod::polynomial),
                                  NormalCdf(GaussianMethod::exact)};
    const char* const names[4] = {"table(64)", "table(1024)", "polynomial", "exact"};
    for (int c = 0; c < 4; ++c) {
        ChartSeries series{.label = names[c]};
        for (int i = 0; i < 240; ++i) {
            // The largest of 16 neighbours: rounding is noise, its envelope is a curve.
            const double x = -6.0 + 12.0 * (i + 0.5) / 240;
            double largest = 1e-12;
            for (int k = 0; k < 16; ++k) {
                const auto xf = static_cast<float>(x + 0.05 * (k + 0.5) / 16);
                largest = std::max(largest, std::abs(double(choices[c](xf)) - static_cast<double>(oracle::phi(xf))));
            }
            series.x.push_back(x), series.y.push_back(largest);
        }
        byX.series.push_back(series);
    }
    run.add({"12", byX});
}

}  // namespace

void checkGaussian(CheckRun& run)
{
    checkPhi(run, GaussianMethod::polynomial, 0, "kPolynomialCdfMaxError");
    checkPhi(run, GaussianMethod::exact, 0, "kExactCdfMaxError");
    for (const int entries : {2, 64, 256, 1024, 4096, 65536}) checkPhi(run, GaussianMethod::table, entries, "tableCdfMaxError(n)");
    checkTableNodes(run);
    checkExactDouble(run);

    std::vector<EquationTrade> tables;
    for (int entries = 64; entries <= 4096; entries *= 2) {
        const double bound = double(gaussianVisibilityMaxError(NormalCdf(GaussianMethod::table, entries)));
        tables.push_back(checkVisibility(run, GaussianMethod::table, entries, entries == 1024, {"gaussianVisibilityMaxError", bound}));
    }
    checkVisibility(run, GaussianMethod::polynomial, 0, true, {"gaussianVisibilityMaxError", double(gaussianVisibilityMaxError(NormalCdf()))});
    checkVisibility(run, GaussianMethod::exact, 0, true, {"kExactCdfMaxError", double(kExactCdfMaxError)});
    checkStep(run);
    addCurves(run, tables);
}

}  // namespace lrsm
