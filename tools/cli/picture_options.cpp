// Options that say what a picture is to be like, and where it goes.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/suggestion.hpp"
#include "core/film/ocio.hpp"
#include "core/network/graph/graph_film.hpp"
#include "tools/cli/options.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

std::optional<PictureSize> size_of(std::string_view text) {
    PictureSize size;
    const auto cross = text.find('x');
    for (auto [part, side] : {std::pair{text.substr(0, cross), &size.width},
                              {text.substr(std::min(cross, text.size() - 1) + 1), &size.height}}) {
        const auto [end, fault] = std::from_chars(part.begin(), part.end(), *side);
        if (fault != std::errc{} || end != part.end() || *side < 1) return std::nullopt;
    }
    return size;
}

// What is wrong with a size; "": nothing.
std::string mistake_in_size(const std::string& text) {
    const auto size = size_of(text);
    if (!size) return "a size is like 640x480, not " + text;
    if (size->width <= longest_side && size->height <= longest_side) return {};
    return "a picture has at most " + std::to_string(longest_side) + " pixels along each side, not " + text;
}

std::optional<PictureCrop> crop_of(std::string_view text) {
    std::array<std::uint32_t, 4> edges{};
    const char* at = text.begin();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (i > 0 && (at == text.end() || *at++ != ',')) return std::nullopt;
        const auto [end, fault] = std::from_chars(at, text.end(), edges[i]);
        if (fault != std::errc{}) return std::nullopt;
        at = end;
    }
    if (at != text.end()) return std::nullopt;
    return PictureCrop{edges[0], edges[1], edges[2], edges[3]};
}

}  // namespace

void add_picture(CLI::App& verb, PictureOptions& picture) {
    takes_numbers(verb.add_option("--samples", picture.samples, "samples per pixel, instead of the graph's"), "N", 1,
                  std::numeric_limits<std::uint32_t>::max());
    verb.add_option("--noise", picture.noise,
                    "end parts of the picture whose noise is this, before they have all samples: a threshold as in "
                    "Cycles, like 0.05, instead of the graph's; 0: none")
        ->type_name("X")
        ->check(CLI::Range(0.0, 1.0));
    verb.add_option_function<std::string>(
            "--size", [&picture](const std::string& text) { picture.size = size_of(text); },
            "size of the picture, instead of the graph's")
        ->type_name("WxH")
        ->check(mistake_in_size);
    verb.add_option_function<std::string>(
            "--crop", [&picture](const std::string& text) { picture.crop = crop_of(text); },
            "only this part of the picture, instead of the graph's: edges in pixels, from the upper left corner")
        ->type_name("X0,Y0,X1,Y1")
        ->check([](const std::string& text) {
            return crop_of(text) ? "" : "a crop is like 10,20,110,80 (left, top, right, bottom), not " + text;
        });
}

void add_clean(CLI::App& verb, PictureOptions& picture) {
    verb.add_flag("--clean", picture.clean,
                  "write a picture without noise, too (x.clean.exr beside x.exr), as 'clean' of the graph's film does");
}

CLI::Option* add_gains(CLI::App& verb, const char* name, std::vector<Gain>& gains, const char* help) {
    const auto add = [&gains](const std::vector<std::string>& given) {
        for (const auto& one : given) gains.push_back(gain_of(one));
    };
    const auto check = [](const std::string& text) -> std::string {
        try {
            gain_of(text);
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    };
    return verb.add_option_function<std::vector<std::string>>(name, add, help)
        ->type_name("LAYER=X|R,G,B")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->check(check);
}

namespace {

// "" where it is one.
std::string mistake_in_view(const std::string& text) {
    if (picture_view(text)) return "";
    try {
        auto known = ocio::views();
        if (std::find(known.begin(), known.end(), text) != known.end()) return "";
        const bool none = known.empty();
        known.insert(known.end(), {"auto", "plain", "filmic", "aces", "agx"});
        return "must be auto, plain, filmic, aces, agx or a view of the config of OpenColorIO that $OCIO names" +
               std::string(none ? " (which names none)" : "") + ", not '" + text + "'" + did_you_mean(text, known);
    } catch (const Error& error) {
        return error.what();
    }
}

}  // namespace

void add_view(CLI::App& verb, PngRequest& png) {
    verb.add_option_function<std::string>(
            "--view",
            [&png](const std::string& text) {
                png.view = picture_view(text).value_or(PictureView::ocio);
                png.ocio = png.view == PictureView::ocio ? text : "";
            },
            "how the PNG shows the picture; auto: with an exposure by which it can be seen, unless one was chosen; "
            "plain: as computed; filmic, aces, agx: as auto, with such a curve; VIEW or DISPLAY/VIEW: as auto, by "
            "OpenColorIO and the config that $OCIO names. The EXR is the same")
        ->type_name("auto|plain|filmic|aces|agx|VIEW")
        ->check(mistake_in_view);
}

void add_png(CLI::App& verb, PngRequest& png, const char* alpha_help) {
    add_view(verb, png);
    verb.add_option("--exposure", png.stops,
                    "show the picture so many stops brighter in the PNG; each makes it twice as bright. The EXR is the "
                    "same: gains change that, or 'exposure' of the graph's scene")
        ->type_name("STOPS");
    if (alpha_help) verb.add_flag("--alpha", png.alpha, alpha_help);
}

void add_output(CLI::App& verb, std::string& file, const char* help) {
    verb.add_option("-o,--output", file, help)->type_name("OUT.exr");
}

void add_arrays(CLI::App& verb, std::string& file) {
    verb.add_option("--npz", file, "write the picture as arrays of NumPy, too, for numpy.load()")
        ->type_name("FILE.npz")
        ->check([](const std::string& text) {
            return text.ends_with(".npz") ? "" : "a file of arrays is called like x.npz, not " + text;
        });
}

}  // namespace lightnet
