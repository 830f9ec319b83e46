// lightnet clean: takes noise out of a picture, without rendering.
#include "core/film/clean/clean.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <filesystem>
#include <ostream>
#include <utility>

#include "core/base/own_files.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/pictures/clean.hpp"
#include "tools/pictures/output_file.hpp"
#include "tools/pictures/picture_lock.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct CleanOptions {
    std::string picture, output;
    bool best = false;
    PngRequest png;
};

void describe_clean(CLI::App& verb, CleanOptions& options) {
    verb.add_option(
            "IMAGE", options.picture,
            "a picture as lightnet writes it; best one that was rendered with --clean, which has what this needs")
        ->required()
        ->type_name("IMAGE.exr");
    verb.add_flag("--best", options.best, "take four times as long for a little less error");
    add_png(verb, options.png, "the PNG has the picture's alpha, where that has one (A)");
    add_output(verb, options.output, "file of the new picture (default: x.clean.exr, beside x.exr)");
    add_examples(verb, {"lightnet clean cornell.exr", "lightnet clean cornell.exr --best -o quiet.exr"});
}

Picture noisy_picture(const std::string& file) {
    Picture picture;
    try {
        picture = read_exr(file);
    } catch (const Error& error) {
        throw UserError({file, 0}, std::string("can't be read: ") + error.what());
    }
    if (picture.notes.texts.contains(cleaned_note)) throw UserError({file, 0}, "is clean already");
    return picture;
}

int clean_file(const CleanOptions& options, const Launcher& launcher) {
    const std::string output = options.output.empty() ? clean_beside(options.picture) : options.output;
    std::error_code not_there;
    if (std::filesystem::equivalent(options.picture, output, not_there))
        throw UserError({output, 0}, "is the noisy picture, and would be lost: choose another --output");
    check_output(output);
    Picture noisy = noisy_picture(options.picture);
    const PictureLock lock(output);
    const auto begun = std::chrono::steady_clock::now();
    const Cleaned cleaned = clean(std::move(noisy), options.best ? CleanQuality::best : CleanQuality::usual);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun;
    for (const auto& lack : cleaned.lacks) launcher.err << options.picture << ": " << lack << '\n';
    const auto png = png_beside(output);
    write_exr(output, cleaned.picture);
    write_png(png, cleaned.picture, png_view(options.png, brightness_of(cleaned.picture)));
    launcher.err << output << ", " << png.string() << ": cleaned in " << seconds.count() << " s\n";
    return exit_code::done;
}

}  // namespace

Verb clean_verb() {
    return verb<CleanOptions>("clean", "take noise out of a picture whose layers still add up", describe_clean,
                              clean_file);
}

}  // namespace lightnet
