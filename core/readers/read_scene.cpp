#include "core/readers/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/unwanted.hpp"

#include "core/readers/gltf/gltf.hpp"
#include "core/readers/mitsuba/mitsuba.hpp"
#include "core/readers/obj/obj.hpp"
#include "core/readers/pbrt/pbrt.hpp"
#include "core/readers/ply/ply.hpp"
#include "core/readers/shutter.hpp"
#include "core/scene/bsdf/check_materials.hpp"
#include "core/scene/reach.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet {
namespace {

const std::string reads_outside = "reads files outside of its folder";

/// Files of one scene, and the first that lies elsewhere.
class Watched final : public Files {
public:
    Watched(Files& files, const std::string& scene) : files_(files), scene_(scene) {}
    Bytes read(const std::string& path) override {
        end_if_unwanted();
        auto bytes = files_.read(path);
        if (outside_.empty() && path != scene_ && !stays_beside(files_, scene_, path)) outside_ = path;
        return bytes;
    }
    std::vector<std::byte> beginning(const std::string& path, std::size_t most) override {
        return files_.beginning(path, most);
    }
    std::optional<std::string> like(const std::string& path) override { return files_.like(path); }
    std::string real_path(const std::string& path) const override { return files_.real_path(path); }
    /// "": all of them are where the scene is, or below.
    const std::string& outside() const { return outside_; }

private:
    Files& files_;
    const std::string& scene_;
    std::string outside_;
};

std::string ending_of(const std::string& path) {
    std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return ending;
}

const SceneFormat* format_of(const std::string& path, std::span<const SceneFormat> formats) {
    const std::string ending = ending_of(path);
    const auto found = std::ranges::find_if(formats, [&](const SceneFormat& format) {
        return std::ranges::find(format.endings, ending) != format.endings.end();
    });
    return found == formats.end() ? nullptr : &*found;
}

std::vector<SceneFormat>& all_formats() {
    static std::vector formats{pbrt::format(), mitsuba::format(), gltf::format(), obj::format(), ply::format()};
    return formats;
}

/// "'.a', '.b' (somebody) or '.c'"
std::string endings_text(std::span<const SceneFormat> formats) {
    std::vector<std::string> endings;
    for (const SceneFormat& format : formats)
        for (const auto ending : format.endings)
            endings.push_back("'" + std::string(ending) + "'" +
                              (format.maker.empty() ? "" : " (" + std::string(format.maker) + ")"));
    std::string text;
    for (std::size_t i = 0; i < endings.size(); ++i)
        text += (i == 0 ? "" : i + 1 < endings.size() ? ", " : " or ") + endings[i];
    return text;
}

/// "Mitsuba's scenes ('.xml'), scenes in '.gltf'"
std::string with_variables(std::span<const SceneFormat> formats) {
    std::string text;
    for (const SceneFormat& format : formats)
        if (format.has_variables)
            text += (text.empty() ? "" : ", ") +
                    (format.maker.empty() ? "scenes in '" : std::string(format.maker) + "'s scenes ('") +
                    std::string(format.endings.front()) + (format.maker.empty() ? "'" : "')");
    return text;
}

SceneData read(Files& files, const std::string& path, const SceneConstants& constants,
               std::span<const SceneFormat> formats) {
    const SceneFormat* format = format_of(path, formats);
    if (format && !format->moves &&
        (constants.contains(std::string(time_constant)) || constants.contains(std::string(animation_constant)))) {
        if (constants.contains(std::string(animation_constant)))
            throw UserError({path, 0}, "nothing in such a file is animated, so no 'animation' can be chosen");
        SceneConstants others = constants;
        others.erase(std::string(time_constant));
        return read(files, path, others, formats);
    }
    if (!constants.empty() && !(format && format->has_variables))
        throw UserError({path, 0}, "only " + with_variables(formats) + " have variables: there is no '" +
                                       constants.begin()->first + "' to define");
    if (!format) throw UserError({path, 0}, "a scene must be a " + endings_text(formats) + " file");
    return format->read(files, path, constants);
}

double seconds_in(const std::string& text) {
    double seconds = 0;
    std::from_chars(text.data(), text.data() + text.size(), seconds);
    return seconds;
}

/// The file's own shutter is that of its own time: where another moment is asked for, that is an instant.
std::optional<ShutterSpan> own_shutter(const SceneData& scene, bool timed) {
    if (timed || scene.animations.empty() || !scene.shutter) return std::nullopt;
    return scene.shutter->close > scene.shutter->open ? scene.shutter : std::nullopt;
}

/// What is said of a shutter, if anything, and all else apart from it.
SceneData read_all_its_time(Files& files, const std::string& path, SceneConstants constants,
                            std::span<const SceneFormat> formats) {
    const auto said = constants.extract(std::string(shutter_constant));
    const SceneFormat* format = format_of(path, formats);
    if (!format || !format->moves) return read(files, path, constants, formats);
    const auto read_at = [&](double seconds) {
        SceneConstants then = constants;
        then[std::string(time_constant)] = fmt::format("{}", seconds);
        return read(files, path, then, formats);
    };
    if (said) {
        const auto time = constants.extract(std::string(time_constant));
        const double now = time ? seconds_in(time.mapped()) : 0;
        const std::string& span = said.mapped();
        return read_in_shutter(read_at, {now + seconds_in(span), now + seconds_in(span.substr(span.find(' ') + 1))},
                               path);
    }
    SceneData scene = read(files, path, constants, formats);
    const auto own = own_shutter(scene, constants.contains(std::string(time_constant)));
    if (!own) return scene;
    scene = {};  // there may not be room for two
    return read_in_shutter(read_at, *own, path);
}

/// What each reader would have to look for: names that lead nowhere or in circles.
void check(const SceneData& scene, const std::string& path) try {
    check_textures(scene.textures);
    check_materials(scene.materials, scene.textures.size());
    if (auto problems = out_of_reach(scene, path); !problems.empty()) throw UserError(std::move(problems));
} catch (const Error& problem) {
    throw UserError({path, 0}, problem.what());
}

}  // namespace

std::span<const SceneFormat> scene_formats() { return all_formats(); }

void add_scene_formats(const std::vector<SceneFormat>& formats) {
    auto all = all_formats();
    for (const SceneFormat& format : formats) {
        if (format.endings.empty() || !format.read)
            throw Error("brings a format of scenes that has no ending or reader");
        for (const auto ending : format.endings) {
            if (ending.size() < 2 || ending != ending_of(std::string(ending)))
                throw Error("brings scenes that end in '" + std::string(ending) +
                            "': an ending has a dot, and no large letters");
            if (const auto* known = format_of(std::string(ending), all))
                throw Error(
                    "brings scenes that end in '" + std::string(ending) + "', which " +
                    (known->plugin.empty() ? "lightnet reads already" : known->plugin + " has brought already"));
        }
        all.push_back(format);
    }
    all_formats() = std::move(all);
}

const SceneFormat* scene_format_of(const std::string& path) { return format_of(path, scene_formats()); }

bool is_named_like_a_scene(const std::string& path) { return scene_format_of(path) != nullptr; }

SceneData read_scene(Files& files, const std::string& path, const SceneConstants& constants) {
    return read_scene(files, path, constants, scene_formats());
}

SceneData read_scene(Files& files, const std::string& path, const SceneConstants& constants,
                     std::span<const SceneFormat> formats) {
    Watched watched(files, path);
    SceneData scene = read_all_its_time(watched, path, constants, formats);
    check(scene, path);
    if (!watched.outside().empty())
        scene.warnings.push_back(
            {{path, 0}, reads_outside + ", such as '" + watched.outside() + "': hosts are sent them as well"});
    return scene;
}

bool is_of_files_outside(const Problem& warning) { return warning.what.starts_with(reads_outside); }

}  // namespace lightnet
