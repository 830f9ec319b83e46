// lightnet fit: finds the gains that bring a picture's layers near another picture.
#include <CLI/CLI.hpp>

#include <ostream>
#include <system_error>

#include "core/base/error.hpp"
#include "core/film/compare.hpp"
#include "core/film/fit.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/pictures/compare.hpp"
#include "tools/pictures/output_file.hpp"
#include "tools/pictures/picture_input.hpp"
#include "tools/pictures/remix.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct FitOptions {
    std::string picture, target, output;
    bool grey = false;
    PngRequest view;
};

void describe_fit(CLI::App& verb, FitOptions& options) {
    verb.add_option("IMAGE", options.picture, "a picture with layers, as lightnet writes them")
        ->required()
        ->type_name("IMAGE.exr");
    verb.add_option("--to", options.target, "the picture to come near: EXR, HDR, PNG or JPEG, of the same size")
        ->required()
        ->type_name("TARGET");
    verb.add_flag("--grey", options.grey, "one gain for all channels of a layer");
    add_view(verb, options.view);
    add_output(verb, options.output, "write the picture with these gains, too");
    add_examples(verb, {"lightnet fit cornell.exr --to photo.exr -o fitted.exr"});
}

int fit_picture(const FitOptions& options, const Launcher& launcher) {
    check_inputs_stay(options.output, {options.target});
    Picture picture = read_layers(options.picture);
    const Picture target = picture_of_user(options.target);
    std::vector<Gain> gains;
    try {
        gains = fit(picture, target, options.grey);
    } catch (const Error& error) {
        throw UserError({options.target, 0}, error.what());
    }
    for (const auto& gain : gains) launcher.out << to_string(gain) << '\n';
    mix(picture, {});
    const auto before = compare(target, picture).relative_square;
    mix(picture, gains);
    const auto after = compare(target, picture).relative_square;
    launcher.err << "relMSE to " << options.target << ": " << before << " with gains of 1, " << after
                 << " with these\n";
    if (!options.output.empty()) write_remix(picture, options.output, options.view, launcher.err);
    return exit_code::done;
}

}  // namespace

Verb fit_verb() {
    return verb<FitOptions>("fit", "find the gains that bring a picture near another one", describe_fit, fit_picture);
}

}  // namespace lightnet
