// One frame by the library: `lrsm render SCENE --size 160x90` without its files.
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/scene/load_scene.h"
#include "core/settings/settings_table.h"

#include <iostream>

int main(int argc, char** argv)
try {
    const lrsm::Scene scene = lrsm::loadScene(argc > 1 ? argv[1] : "cornell-box", {});
    const lrsm::Settings settings = lrsm::preset("balanced");
    lrsm::RenderOptions options;
    options.width = 160;
    options.height = 90;
    const lrsm::Frame frame = lrsm::renderFrame(scene, lrsm::findCamera(scene, "0"), settings, options);

    double sum = 0.0;
    for (const lrsm::Vec3& e : frame.irradiance.texels) sum += (double(e.x) + double(e.y) + double(e.z)) / 3.0;
    std::cout << "mean irradiance " << sum / double(frame.irradiance.texels.size()) << " W/m^2\n";
    std::cout << "composite sha256 " << frame.passes.back().sha256 << "\n";
    return 0;
} catch (const lrsm::InputError& error) {
    std::cerr << error.what() << "\n";
    return 2;
}
