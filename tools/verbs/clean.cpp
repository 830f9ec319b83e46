// lightnet clean: takes noise out of a picture, without rendering.
#include "core/film/clean/clean.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <map>
#include <ostream>
#include <utility>

#include "core/base/frame_name.hpp"
#include "core/base/own_files.hpp"
#include "core/film/clean/across.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/pictures/clean.hpp"
#include "tools/pictures/film_strip.hpp"
#include "tools/pictures/output_file.hpp"
#include "tools/pictures/picture_input.hpp"
#include "tools/pictures/picture_lock.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

constexpr int most_across = 8;  // cleaned pictures to each side, which are held at once

struct CleanOptions {
    std::string picture, output;
    bool best = false;
    int across = 0;           // frames to each side that help
    std::vector<int> frames;  // of a sequence; none: all
    PngRequest png;
};

void describe_clean(CLI::App& verb, CleanOptions& options) {
    verb.add_option(
            "IMAGE", options.picture,
            "a picture as lightnet writes it; best one that was rendered with --clean, which has what this needs")
        ->required()
        ->type_name("IMAGE.exr|SHOT.####.exr");
    add_only_frames(verb, options.frames);
    verb.add_option("--across", options.across,
                    "so many frames to each side help, by the vectors of SurfaceFact { of = \"motion\" }")
        ->type_name("N")
        ->check(CLI::Range(0, most_across));
    verb.add_flag("--best", options.best, "take four times as long for a little less error");
    add_png(verb, options.png, "the PNG has the picture's alpha, where that has one (A)");
    add_output(verb, options.output, "file of the new picture (default: x.clean.exr, beside x.exr)");
    add_examples(verb, {"lightnet clean cornell.exr", "lightnet clean cornell.exr --best -o quiet.exr",
                        "lightnet clean shot.####.exr --across 1 -o quiet.####.exr"});
}

Picture noisy_picture(const std::string& file) {
    Picture picture = layers_of_user(file);
    if (picture.notes.texts.contains(cleaned_note)) throw UserError({file, 0}, "is clean already");
    return picture;
}

/// Where a picture goes. Throws UserError where the noisy one would be lost.
std::string place_of(const std::string& noisy, const std::string& output) {
    check_inputs_stay(output, {noisy});
    check_output(output);
    return output;
}

/// Cleans files one after the other.
class Cleaning {
public:
    Cleaning(const CleanOptions& options, const Launcher& launcher) : options_(options), launcher_(launcher) {}

    Picture picture(const std::string& file) const {
        Cleaned cleaned = clean(noisy_picture(file), options_.best ? CleanQuality::best : CleanQuality::usual);
        for (const auto& lack : cleaned.lacks) launcher_.err << file << ": " << lack << '\n';
        return std::move(cleaned.picture);
    }
    void write(const Picture& cleaned, const std::string& output) {
        const auto png = png_beside(output);
        write_exr(output, cleaned);
        write_png(png, cleaned, png_view(options_.png, brightness_of(cleaned)));
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun_;
        begun_ = std::chrono::steady_clock::now();
        launcher_.err << output << ", " << png.string() << ": cleaned in " << seconds.count() << " s\n";
    }

private:
    const CleanOptions& options_;
    const Launcher& launcher_;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

int clean_one(const CleanOptions& options, const Launcher& launcher) {
    if (options.across > 0 || !options.frames.empty())
        throw UserError({options.picture, 0},
                        "is one picture: --frames and --across are for a sequence, shot.####.exr");
    const std::string output =
        place_of(options.picture, options.output.empty() ? clean_beside(options.picture) : options.output);
    const PictureLock lock(output);
    Cleaning cleaning(options, launcher);
    cleaning.write(cleaning.picture(options.picture), output);
    return exit_code::done;
}

/// The frames of a sequence, as many as help each other at a time.
int clean_frames(const CleanOptions& options, const Launcher& launcher) {
    if (!options.output.empty() && !has_frame_place(options.output))
        throw UserError({options.output, 0}, "has no place for the numbers of frames: name it like quiet.####.exr");
    std::map<int, std::string> files, outputs;
    for (const auto& frame : frame_files(options.picture)) files.emplace(frame.number, frame.file);
    for (const auto& [number, file] : frame_files(options.picture, options.frames))
        outputs[number] =
            place_of(file, options.output.empty() ? clean_beside(file) : with_frame(options.output, number));
    Cleaning cleaning(options, launcher);
    std::map<int, Picture> cleaned;
    for (const auto& [number, output] : outputs) {
        const PictureLock lock(output);
        cleaned.erase(cleaned.begin(), cleaned.lower_bound(number - options.across));
        for (int other = number - options.across; other <= number + options.across; ++other) {
            const auto there = files.find(other);
            if (there == files.end() || cleaned.contains(other)) continue;
            const Picture& picture = cleaned.emplace(other, cleaning.picture(there->second)).first->second;
            if (const auto fault = fault_across(picture); options.across > 0 && !fault.empty())
                throw UserError({there->second, 0}, fault);
        }
        cleaning.write(options.across > 0 ? joined_across(cleaned, number) : cleaned.at(number), output);
    }
    return exit_code::done;
}

int clean_file(const CleanOptions& options, const Launcher& launcher) {
    return has_frame_place(options.picture) ? clean_frames(options, launcher) : clean_one(options, launcher);
}

}  // namespace

Verb clean_verb() {
    return verb<CleanOptions>("clean", "take noise out of a picture whose layers still add up", describe_clean,
                              clean_file);
}

}  // namespace lightnet
