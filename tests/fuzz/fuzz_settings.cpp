#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

using namespace lrsm;

/// Whatever the text, settings are refused with an InputError or end up valid, and a valid one survives the way to JSON and back.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    Settings settings = preset("balanced");
    try {
        applySetting(settings, text);
    } catch (const InputError&) {
    }
    const auto object = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions*/ false);
    try {
        if (!object.is_discarded()) applySettingsJson(settings, object, "fuzz");
    } catch (const InputError&) {
    }
    try {
        validate(settings);
    } catch (const InputError&) {
        return 0;
    }
    Settings back;
    applySettingsJson(back, settingsToJson(settings), "fuzz");
    if (!(back == settings)) std::abort();
    return 0;
}
