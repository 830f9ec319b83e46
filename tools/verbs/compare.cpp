// lightnet compare: tells how far pictures are from a reference.
#include "tools/pictures/compare.hpp"

#include <CLI/CLI.hpp>

#include "tools/cli/launcher.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

void add_tolerances(CLI::App& verb, CompareRequest& request) {
    const auto add = [&](const char* name, std::optional<double>& most, const char* help) {
        takes_amounts(verb.add_option(name, most, help), "X", Least::zero)->group("Tolerances");
    };
    add("--max-relmse", request.max_relmse, "relMSE: mean of d² / (reference² + 0.01)");
    add("--max-trimmed", request.max_trimmed, "relMSE without the worst 0.1 % of the pixels");
    add("--max-blocks", request.max_blocks, "mean relative difference of blocks of 16 x 16 pixels");
    add("--max-bias", request.max_bias, "how far from 1 the ratio of the means is, in the worst channel");
    add("--max-flip", request.max_flip, "mean FLIP");
    verb.add_flag("--equal-bytes", request.equal_bytes, "every pixel of every layer must be the same, bit for bit")
        ->group("Tolerances");
}

void describe_compare(CLI::App& verb, CompareRequest& request) {
    verb.add_option("REFERENCE", request.reference, "the picture to hold the others against")->required();
    verb.add_option("IMAGE", request.pictures, "pictures: EXR, or HDR, PNG and JPEG, which have no layers")->required();
    verb.add_flag("--json", request.json, "print JSON");
    verb.add_option("--difference", request.difference,
                    "write image minus reference: .exr with its sign and layers, or .png without its sign")
        ->type_name("FILE.exr|.png");
    verb.add_option("--flip-map", request.flip_map, "write FLIP of each pixel, from black (0) to pale yellow (1)")
        ->type_name("FILE.png");
    verb.add_option("--exposure", request.view.exposure, "stops, before pictures are shown: for FLIP and .png")
        ->type_name("STOPS")
        ->capture_default_str();
    takes_amounts(verb.add_option("--pixels-per-degree", request.view.pixels_per_degree,
                                  "pixels per degree of what the eye sees, for FLIP"),
                  "N", Least::above_zero)
        ->capture_default_str();
    add_tolerances(verb, request);
    verb.footer(
        "FLIP (Andersson et al. 2020) is of the pictures as a PNG shows them: exposed, clipped to 0..1, sRGB.\n"
        "Tolerances are for the beauty, --equal-bytes is for all layers.\n"
        "Exit codes: 0 done, 1 a tolerance is passed, 2 a picture can't be read or has another size.\n\n"
        "Examples:\n"
        "  lightnet compare reference.exr cornell.exr --max-relmse 0.01\n"
        "  lightnet compare reference.exr cornell.exr --flip-map flip.png --json");
}

int compare(const CompareRequest& request, const Launcher& launcher) {
    return compare_pictures(request, launcher.out, launcher.err);
}

}  // namespace

Verb compare_verb() {
    return verb<CompareRequest>("compare", "measure how far pictures are from a reference", describe_compare, compare);
}

}  // namespace lightnet
