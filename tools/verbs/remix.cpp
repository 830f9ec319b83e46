// lightnet remix: mixes the layers of a picture anew, without rendering.
#include <CLI/CLI.hpp>

#include <filesystem>

#include "core/film/gains.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/pictures/remix.hpp"
#include "tools/support/command_line.hpp"
#include "tools/support/exit_code.hpp"

namespace lightnet {
namespace {

struct RemixOptions {
    std::string picture, output;
    std::vector<Gain> gains;
    PictureView view = PictureView::automatic;
};

void describe_remix(CLI::App& verb, RemixOptions& options) {
    verb.add_option("IMAGE", options.picture, "a picture with layers, as lightnet writes them")
        ->required()
        ->type_name("IMAGE.exr");
    add_gains(verb, "GAIN", options.gains, "times which a layer is in the new picture; those not named: once")
        ->expected(0, -1)
        ->allow_extra_args();
    add_view(verb, options.view);
    add_output(verb, options.output, "file of the new picture (default: x.remix.exr, beside x.exr)");
    add_examples(verb, {"lightnet remix cornell.exr direct=0.5 bounce=1.2,1.1,1",
                        "lightnet remix cornell.exr direct=0.5 -o dim.exr"});
}

int remix(const RemixOptions& options, const Launcher& launcher) {
    Picture picture = read_layers(options.picture);
    mix_or_complain(picture, options.gains, options.picture);
    const auto usual = std::filesystem::path(options.picture).replace_extension(".remix.exr").string();
    write_remix(picture, options.output.empty() ? usual : options.output, options.view, launcher.err);
    return exit_code::done;
}

}  // namespace

Verb remix_verb() {
    return verb<RemixOptions>("remix", "mix the layers of a picture anew, without rendering", describe_remix, remix);
}

}  // namespace lightnet
