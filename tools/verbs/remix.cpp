// lightnet remix: mixes the layers of a picture anew, without rendering.
#include <CLI/CLI.hpp>

#include <filesystem>

#include "core/base/frame_name.hpp"
#include "core/base/own_files.hpp"
#include "core/film/gains.hpp"
#include "core/film/npz.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/pictures/film_strip.hpp"
#include "tools/pictures/remix.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct RemixOptions {
    std::string picture, output;
    std::vector<Gain> gains;
    std::string compression;  // "": as it is
    bool parts = false, one_part = false;
    std::string arrays;       // file; "": none
    bool keep_gains = false;  // of the picture
    std::vector<int> frames;  // of a sequence; none: all
    PngRequest png;
};

void describe_remix(CLI::App& verb, RemixOptions& options) {
    verb.add_option("IMAGE", options.picture, "a picture with layers, as lightnet writes them")
        ->required()
        ->type_name("IMAGE.exr|SHOT.####.exr");
    add_only_frames(verb, options.frames);
    auto* const gains =
        add_gains(verb, "GAIN", options.gains, "times which a layer is in the new picture; those not named: once")
            ->expected(0, -1)
            ->allow_extra_args();
    add_png(verb, options.png, "the PNG has the picture's alpha, where that has one (A)");
    takes_one_of(
        verb.add_option("--compression", options.compression, "how the new EXR is packed, instead of as IMAGE"),
        lossless_compressions());
    auto* const parts = verb.add_flag("--parts", options.parts, "each layer has a part of its own in the new EXR");
    verb.add_flag("--one-part", options.one_part, "all layers are in one part, as IMAGE may not have them")
        ->excludes(parts);
    add_arrays(verb, options.arrays);
    verb.add_flag("--keep-gains", options.keep_gains, "all layers keep the gains that they have in IMAGE")
        ->excludes(gains);
    add_output(verb, options.output, "file of the new picture (default: x.remix.exr, beside x.exr)");
    add_examples(verb, {"lightnet remix cornell.exr direct=0.5 bounce=1.2,1.1,1",
                        "lightnet remix cornell.exr direct=0.5 -o dim.exr",
                        "lightnet remix shot.####.exr direct=0.5 -o dim.####.exr"});
}

int remix_one(const RemixOptions& options, const Launcher& launcher) {
    Picture picture = read_layers(options.picture);
    if (!options.keep_gains) mix_or_complain(picture, options.gains, options.picture);
    if (!options.compression.empty()) picture.storage.compression = options.compression;
    if (options.parts || options.one_part) picture.storage.parts = options.parts;
    const auto usual = std::filesystem::path(options.picture).replace_extension(".remix.exr").string();
    write_remix(picture, options.output.empty() ? usual : options.output, options.png, launcher.err);
    if (!options.arrays.empty()) {
        expect_ours(options.arrays, npz_beginning);
        write_npz(options.arrays, picture);
    }
    return exit_code::done;
}

int remix(const RemixOptions& options, const Launcher& launcher) {
    if (!has_frame_place(options.picture)) {
        if (options.frames.empty()) return remix_one(options, launcher);
        throw UserError({options.picture, 0}, "is one picture: --frames are those of a sequence, shot.####.exr");
    }
    for (const auto* name : {&options.output, &options.arrays})
        if (!name->empty() && !has_frame_place(*name))
            throw UserError({*name, 0}, "has no place for the numbers of frames: name it like mixed.####.exr");
    for (const auto& [number, file] : frame_files(options.picture, options.frames)) {
        RemixOptions of_frame = options;
        of_frame.picture = file;
        of_frame.output = with_frame(options.output, number);
        of_frame.arrays = with_frame(options.arrays, number);
        remix_one(of_frame, launcher);
    }
    return exit_code::done;
}

}  // namespace

Verb remix_verb() {
    return verb<RemixOptions>("remix", "mix the layers of a picture anew, without rendering", describe_remix, remix);
}

}  // namespace lightnet
