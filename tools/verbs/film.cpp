// lightnet film: makes a film of the frames of a sequence.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/frame_name.hpp"
#include "core/base/own_files.hpp"
#include "core/base/temporary_folder.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/pictures/film_strip.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

constexpr double usual_rate = 24;  // frames per second

struct FilmOptions {
    std::string pictures, output, sheet;
    FrameOptions frames;
    PngRequest view;
};

void describe_film(CLI::App& verb, FilmOptions& options) {
    verb.add_option("FRAMES", options.pictures, "the pictures, with a place for the number: shot.####.exr")
        ->required()
        ->type_name("SHOT.####.exr");
    verb.add_option("-o,--output", options.output,
                    "the film, made by ffmpeg; or numbered pictures: film.####.png (default: shot.mp4)")
        ->type_name("FILM.mp4|FILM.####.png");
    verb.add_option("--sheet", options.sheet, "write all frames small in one picture, too")->type_name("SHEET.png");
    add_only_frames(verb, options.frames.numbers);
    takes_amounts(verb.add_option("--fps", options.frames.fps, "frames per second, instead of 24"), "N",
                  Least::above_zero);
    add_view(verb, options.view);
    add_examples(verb, {"lightnet film film.####.exr -o film.mp4", "lightnet film film.####.exr --sheet sheet.png"});
}

// Where ffmpeg is not installed, what it would have been given stays.
int write_film(const FilmOptions& options, const std::vector<FrameFile>& frames, const PngView& view,
               const Launcher& launcher) {
    std::string film = options.output;
    if (film.empty())
        film = std::filesystem::path(without_frame_place(options.pictures)).replace_extension(".mp4").string();
    if (!has_frame_place(film)) expect_film_place(film);
    if (has_frame_place(film)) {
        write_strip(frames, view, film);
        launcher.err << frames.size() << " frames in " << film << '\n';
        return exit_code::done;
    }
    const TemporaryFolder folder("film");
    const std::string strip = folder.path() + "/%06d.png";
    write_strip(frames, view, strip);
    if (encode_film(strip, options.frames.fps > 0 ? options.frames.fps : usual_rate, film)) {
        launcher.err << frames.size() << " frames in " << film << '\n';
        return exit_code::done;
    }
    auto instead = std::filesystem::path(film).replace_extension(".####.png");
    if (instead == png_beside(options.pictures)) instead.replace_extension().replace_extension(".film.####.png");
    write_strip(frames, view, instead.string());
    launcher.err << "ffmpeg is not installed, so the film is " << frames.size()
                 << " numbered pictures: " << instead.string() << '\n';
    return exit_code::done;
}

int make_film(const FilmOptions& options, const Launcher& launcher) {
    const auto frames = frame_files(options.pictures, options.frames.numbers);
    if (const auto missing = missing_frames(frames); !missing.empty() && options.frames.numbers.empty())
        launcher.err << "warning: frames are missing, and the film goes on without them: " << missing << '\n';
    const auto view = view_of_film(frames, options.view);
    if (!options.sheet.empty()) write_sheet(frames, view, options.sheet);
    if (options.sheet.empty() || !options.output.empty()) return write_film(options, frames, view, launcher);
    return exit_code::done;
}

}  // namespace

Verb film_verb() {
    return verb<FilmOptions>("film", "make a film of the frames of a sequence", describe_film, make_film);
}

}  // namespace lightnet
