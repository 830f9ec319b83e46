#include "core/readers/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/unwanted.hpp"

#include "core/readers/gltf/gltf.hpp"
#include "core/readers/mitsuba/mitsuba.hpp"
#include "core/readers/moment_of.hpp"
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
    const auto is_subdivision = [](const auto& constant) { return constant.first.starts_with(subdivision_constant); };
    if (format && !format->subdivides && std::ranges::any_of(constants, is_subdivision))
        throw UserError({path, 0},
                        "'subdivision' is of '.obj' files: of others not all faces are kept as they were made");
    if (!std::ranges::all_of(constants, is_subdivision) && !(format && format->has_variables))
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

std::optional<double> taken_time(SceneConstants& constants) {
    const auto time = constants.extract(std::string(time_constant));
    return time ? std::optional(seconds_in(time.mapped())) : std::nullopt;
}

std::optional<FrameBeside> taken_frame(SceneConstants& constants, std::string_view which) {
    const auto said = constants.extract(std::string(which));
    if (!said) return std::nullopt;
    const std::string& text = said.mapped();
    const auto first = text.find(' '), second = text.find(' ', first + 1);
    FrameBeside frame{seconds_in(text), std::nullopt, text.substr(second + 1)};
    if (const auto time = text.substr(first + 1, second - first - 1); time != "-") frame.time = seconds_in(time);
    return frame;
}

/// One scene at several times, and all that is said of these.
class TimedReader {
public:
    TimedReader(Files& files, const std::string& path, SceneConstants constants, std::span<const SceneFormat> formats)
        : files_(files),
          path_(path),
          formats_(formats),
          previous_(taken_frame(constants, previous_constant)),
          next_(taken_frame(constants, next_constant)),
          constants_(std::move(constants)) {
        const auto said = constants_.extract(std::string(shutter_constant));
        if (!said) return;
        const std::string& span = said.mapped();
        shutter_ = ShutterSpan{seconds_in(span), seconds_in(span.substr(span.find(' ') + 1))};
    }

    SceneData read() { return has_other_files() ? of_files() : of_one_file(); }

private:
    bool is_elsewhere(const std::optional<FrameBeside>& frame) const { return frame && !frame->file.empty(); }
    bool has_other_files() const { return is_elsewhere(previous_) || is_elsewhere(next_); }
    bool asks_for_motion() const { return next_ && next_->time; }
    bool moves() const {
        const SceneFormat* format = format_of(path_, formats_);
        return format && format->moves;
    }
    SceneData read_as(const std::string& path, const SceneConstants& constants) const {
        return lightnet::read(files_, path, constants, formats_);
    }
    SceneData read_at(const std::string& path, double seconds) const {
        SceneConstants then = constants_;
        then[std::string(time_constant)] = fmt::format("{}", seconds);
        return read_as(path, then);
    }

    SceneData of_one_file() {
        if (!moves()) return read_as(path_, constants_);
        SceneData scene = in_shutter();
        if (asks_for_motion() && !scene.animations.empty())
            set_next_frame(scene, read_at(path_, *next_->time + (shutter_ ? shutter_->open : 0)));
        return scene;
    }
    SceneData in_shutter() {
        const std::function<SceneData(double)> at = [&](double seconds) { return read_at(path_, seconds); };
        if (shutter_) {
            const double now = taken_time(constants_).value_or(0);
            return read_in_shutter(at, {now + shutter_->open, now + shutter_->close}, path_);
        }
        SceneData scene = read_as(path_, constants_);
        const auto own = own_shutter(scene, constants_.contains(std::string(time_constant)));
        if (!own) return scene;
        scene = {};  // there may not be room for two
        return read_in_shutter(at, *own, path_);
    }

    /// In frames after its own.
    ShutterSpan shutter_in_frames() const {
        const double frame = (next_ ? next_ : previous_)->seconds_per_frame;
        return shutter_ ? ShutterSpan{shutter_->open / frame, shutter_->close / frame} : ShutterSpan{};
    }
    SceneData of_files() {
        FramesAround frames{read_as(path_, constants_)};
        frames.previous = frame_beside(previous_, frames.now);
        frames.next = frame_beside(next_, frames.now);
        const ShutterSpan shutter = shutter_in_frames();
        SceneData scene = shutter_ ? blurred_between(frames, shutter, path_) : frames.now;
        // as the next frame's shutter opens: on the straight way, also where that is beyond it
        if (asks_for_motion() && frames.next)
            set_next_frame(scene, on_the_way(frames.now, moment_of(std::move(*frames.next), frames.now),
                                             std::max(0.0, 1 + shutter.open)));
        return scene;
    }

    /// None: there is no such frame, as before the first and behind the last.
    std::optional<SceneData> frame_beside(const std::optional<FrameBeside>& frame, SceneData& now) const {
        if (!is_elsewhere(frame)) return std::nullopt;
        std::string why;
        try {
            if (!frame->time || !moves()) return read_as(frame->file, constants_);
            return read_at(frame->file, *frame->time);
        } catch (const MissingHere&) {
            throw;
        } catch (const Error& problem) {
            why = problem.what();
        } catch (const UserError& problem) {
            why = problem.what();
        }
        now.warnings.push_back(
            {{path_, 0}, "stands still between this frame and '" + frame->file + "', which can't be read: " + why});
        return std::nullopt;
    }

    Files& files_;
    const std::string& path_;
    std::span<const SceneFormat> formats_;
    std::optional<FrameBeside> previous_, next_;
    SceneConstants constants_;
    std::optional<ShutterSpan> shutter_;  // seconds after the time
};

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
    SceneData scene = TimedReader(watched, path, constants, formats).read();
    check(scene, path);
    if (!watched.outside().empty())
        scene.warnings.push_back(
            {{path, 0}, reads_outside + ", such as '" + watched.outside() + "': hosts are sent them as well"});
    return scene;
}

std::string to_constant(const FrameBeside& frame) {
    return fmt::format("{} {} {}", frame.seconds_per_frame, frame.time ? fmt::format("{}", *frame.time) : "-",
                       frame.file);
}

bool is_of_files_outside(const Problem& warning) { return warning.what.starts_with(reads_outside); }

}  // namespace lightnet
