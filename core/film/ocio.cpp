#include "core/film/ocio.hpp"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"

namespace lightnet::ocio {
namespace {

namespace Ocio = OCIO_NAMESPACE;

static_assert(sizeof(Rgb) == 3 * sizeof(float));

// What configs call linear colours of BT.709: OpenColorIO's own, ACES's of several years, Blender's.
constexpr std::array our_names{"lin_rec709_scene",
                               "lin_rec709",
                               "Linear Rec.709 (sRGB)",
                               "Linear Rec.709",
                               "lin_srgb",
                               "Utility - Linear - sRGB",
                               "Utility - Linear - Rec.709",
                               "Linear BT.709",
                               "Linear"};

// From BT.709 to the primaries of ACES 2065-1 (AP0), and to CIE XYZ (D65): rows. By the primaries and whites of both;
// the first adapted by Bradford, as ACES does.
constexpr std::array<double, 9> to_aces{0.439632982,  0.382988698,  0.17737832,  0.0897764431, 0.813439429,
                                        0.0967841284, 0.0175411704, 0.111546553, 0.870912277};
constexpr std::array<double, 9> to_xyz{0.412390799,  0.357584339,  0.180480788, 0.212639006, 0.715168679,
                                       0.0721923154, 0.0193308187, 0.119194780, 0.950532152};

Ocio::ConstConfigRcPtr config() {
    const char* const file = std::getenv("OCIO");
    if (!file || !*file) return nullptr;
    try {
        Ocio::SetLoggingLevel(Ocio::LOGGING_LEVEL_NONE);
        return Ocio::Config::CreateFromFile(file);
    } catch (const Ocio::Exception& wrong) {
        throw Error(file, std::string("is no config of OpenColorIO: ") + wrong.what());
    }
}

/// Where a picture's colours are taken from: a colour space of the config, and a matrix on the way to it.
struct Source {
    std::string space;
    std::optional<std::array<double, 9>> matrix{};
};

Source source_in(const Ocio::Config& config) {
    for (const char* name : our_names)
        if (config.getColorSpace(name)) return {name};
    if (config.hasRole("aces_interchange")) return {"aces_interchange", to_aces};
    if (config.hasRole("cie_xyz_d65_interchange")) return {"cie_xyz_d65_interchange", to_xyz};
    throw Error("OpenColorIO",
                "its config has no colour space that is linear with the primaries of BT.709 (lin_rec709), and no role "
                "of interchange");
}

/// A display, and a view of it.
struct Chosen {
    std::string display, view;
};

bool has_view(const Ocio::Config& config, const std::string& display, const std::string& view) {
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
        if (config.getView(display.c_str(), i) == view) return true;
    return false;
}

Chosen chosen_in(const Ocio::Config& config, const std::string& name) {
    const std::string usual = config.getDefaultDisplay();
    if (has_view(config, usual, name)) return {usual, name};
    for (auto slash = name.find('/'); slash != name.npos; slash = name.find('/', slash + 1))
        if (Chosen chosen{name.substr(0, slash), name.substr(slash + 1)}; has_view(config, chosen.display, chosen.view))
            return chosen;
    throw Error("OpenColorIO", "its config has no view '" + name + "'" + did_you_mean(name, views()));
}

Ocio::ConstTransformRcPtr transform_of(const Source& source, const Chosen& chosen) {
    auto view = Ocio::DisplayViewTransform::Create();
    view->setSrc(source.space.c_str());
    view->setDisplay(chosen.display.c_str());
    view->setView(chosen.view.c_str());
    auto all = Ocio::GroupTransform::Create();
    if (source.matrix) {
        std::array<double, 16> rows{};
        for (std::size_t i = 0; i < 9; ++i) rows[i / 3 * 4 + i % 3] = (*source.matrix)[i];
        rows[15] = 1;
        auto matrix = Ocio::MatrixTransform::Create();
        matrix->setMatrix(rows.data());
        all->appendTransform(matrix);
    }
    all->appendTransform(view);
    return all;
}

}  // namespace

std::vector<std::string> views() {
    std::vector<std::string> names;
    const auto found = config();
    if (!found) return names;
    const std::string usual = found->getDefaultDisplay();
    for (int i = 0; i < found->getNumViews(usual.c_str()); ++i) names.emplace_back(found->getView(usual.c_str(), i));
    for (int d = 0; d < found->getNumDisplays(); ++d) {
        const std::string display = found->getDisplay(d);
        for (int i = 0; i < found->getNumViews(display.c_str()); ++i)
            names.push_back(display + "/" + found->getView(display.c_str(), i));
    }
    return names;
}

void show(std::vector<Rgb>& pixels, const std::string& view) try {
    const auto found = config();
    if (!found) throw Error("OpenColorIO", "$OCIO names no config, so there is no view '" + view + "'");
    const auto transform = transform_of(source_in(*found), chosen_in(*found, view));
    // Exactly as the library computes it, not as GPUs would.
    const auto processor = found->getProcessor(transform)->getOptimizedCPUProcessor(
        Ocio::BIT_DEPTH_F32, Ocio::BIT_DEPTH_F32, Ocio::OPTIMIZATION_LOSSLESS);
    if (pixels.empty()) return;
    Ocio::PackedImageDesc image(pixels.data(), static_cast<long>(pixels.size()), 1, 3);
    processor->apply(image);
} catch (const Ocio::Exception& wrong) {
    throw Error("OpenColorIO", wrong.what());
}

}  // namespace lightnet::ocio
