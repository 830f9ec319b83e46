#include "tools/pictures/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <ostream>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/own_files.hpp"
#include "core/film/compare_layers.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"
#include "tools/pictures/picture_input.hpp"
#include "tools/support/exit_code.hpp"

namespace lightnet {
namespace {

// Nothing is written where it can't be understood; said before anything is read.
void check_request(const CompareRequest& request) {
    const auto check = [&](const char* option, const std::string& file, const char* endings, bool fits) {
        if (file.empty()) return;
        if (request.pictures.size() > 1) throw UserError({option, 0}, "takes one picture beside the reference");
        if (!fits) throw UserError({option, 0}, "'" + file + "' must end in " + endings);
    };
    const auto &difference = request.difference, &flip_map = request.flip_map;
    check("--difference", difference, ".exr or .png", has_ending(difference, ".exr") || has_ending(difference, ".png"));
    check("--flip-map", flip_map, ".png", has_ending(flip_map, ".png"));
}

double bias_of(const Difference& difference) {
    const Rgb ratio = difference.mean_ratio;
    double worst = 0;
    for (const float channel : {ratio.r, ratio.g, ratio.b}) {
        const double bias = std::abs(channel - 1.0);
        if (!(bias <= worst)) worst = bias;  // also no number
    }
    return worst;
}

// Every stated tolerance that is passed, in words.
std::vector<std::string> passed(const CompareRequest& request, const Comparison& found) {
    std::vector<std::string> all;
    const auto& beauty = found.layers.front();
    const auto check = [&](const char* name, const std::optional<double>& most, double value) {
        if (most && !(value <= *most)) all.push_back(fmt::format("{} {:.4g} is more than {:.4g}", name, value, *most));
    };
    check("relMSE", request.max_relmse, beauty.difference.relative_square);
    check("trimmed relMSE", request.max_trimmed, beauty.difference.relative_square_trimmed);
    check("difference of blocks", request.max_blocks, beauty.difference.block_difference);
    check("bias", request.max_bias, bias_of(beauty.difference));
    check("FLIP", request.max_flip, beauty.flip);
    if (request.equal_bytes && !found.identical) all.push_back("bits differ");
    return all;
}

void print(const std::string& name, const Comparison& found, std::ostream& out) {
    out << name << ": all bits " << (found.identical ? "are equal" : "are not equal") << '\n';
    std::size_t widest = 0;
    for (const auto& layer : found.layers) widest = std::max(widest, layer.layer.size());
    for (const auto& [layer, difference, flip] : found.layers)
        out << fmt::format(
            "  {}  FLIP {:.4f}  relMSE {:.4g}  trimmed {:.4g}  blocks {:.4f}  mean ratio {:.4f} {:.4f} {:.4f}  "
            "{}\n",
            layer + std::string(widest - layer.size(), ' '), flip, difference.relative_square,
            difference.relative_square_trimmed, difference.block_difference, difference.mean_ratio.r,
            difference.mean_ratio.g, difference.mean_ratio.b, difference.identical ? "bits equal" : "bits differ");
    for (const auto& layer : found.only_in_reference) out << "  layer " << layer << " is only in the reference\n";
    for (const auto& layer : found.only_in_picture) out << "  layer " << layer << " is not in the reference\n";
}

JsonTree json_of(const std::string& file, const Comparison& found, const std::vector<std::string>& beyond) {
    JsonTree layers = JsonTree::list();
    for (const auto& [layer, difference, flip] : found.layers) {
        const Rgb ratio = difference.mean_ratio;
        layers.push_back({{"name", layer},
                          {"identical", difference.identical},
                          {"flip", flip},
                          {"relmse", difference.relative_square},
                          {"relmse_trimmed", difference.relative_square_trimmed},
                          {"mse", difference.mean_square},
                          {"blocks", difference.block_difference},
                          {"mean_ratio", {ratio.r, ratio.g, ratio.b}}});
    }
    return {{"file", file},
            {"identical", found.identical},
            {"layers", std::move(layers)},
            {"only_in_reference", found.only_in_reference},
            {"only_in_image", found.only_in_picture},
            {"too_far", beyond}};
}

/// All that one call of compare says.
class Report {
public:
    Report(const CompareRequest& request, std::ostream& out, std::ostream& err)
        : request_(request), out_(out), err_(err) {}

    int write() {
        check_request(request_);
        const Picture reference = picture_in(request_.reference);
        if (!request_.json)
            out_ << fmt::format("FLIP: {:g} pixels per degree, exposure {:g}, clipped to 0..1, sRGB\n",
                                request_.view.pixels_per_degree, request_.view.exposure);
        for (const auto& name : request_.pictures) add(reference, name);
        if (request_.json) out_ << to_text(json(), {.indent = 2}) << '\n';
        return code_;
    }

private:
    void add(const Picture& reference, const std::string& name) try {
        const Picture picture = picture_in(name);
        const Comparison found = compare_layers(reference, picture, request_.view);
        const auto beyond = passed(request_, found);
        if (!request_.json) print(name, found, out_);
        pictures_.push_back(json_of(name, found, beyond));
        for (const auto& one : beyond) err_ << "lightnet: " << name << ": " << one << '\n';
        if (!beyond.empty()) code_ = std::max(code_, exit_code::failed);
        write_pictures(reference, picture, found);
    } catch (const Error& error) {
        err_ << "lightnet: " << error.what() << '\n';
        pictures_.push_back({{"file", name}, {"error", error.what()}});
        code_ = exit_code::usage;
    }

    void write_pictures(const Picture& reference, const Picture& picture, const Comparison& found) const {
        if (!request_.flip_map.empty()) write_png(request_.flip_map, magma_of(picture.width, found.flip_map));
        if (request_.difference.empty()) return;
        Picture difference = difference_of(reference, picture);
        if (has_ending(request_.difference, ".exr")) return write_exr(request_.difference, difference);
        difference = without_signs(std::move(difference));
        for (Rgb& colour : difference.beauty) colour *= static_cast<float>(std::exp2(request_.view.exposure));
        write_png(request_.difference, difference);
    }

    JsonTree json() const {
        return {{"format", "lightnet compare 1"},
                {"reference", request_.reference},
                {"flip",
                 {{"pixels_per_degree", request_.view.pixels_per_degree},
                  {"exposure", request_.view.exposure},
                  {"tone", "clipped to 0..1, sRGB"}}},
                {"images", pictures_}};
    }

    const CompareRequest& request_;
    std::ostream& out_;
    std::ostream& err_;
    JsonTree pictures_ = JsonTree::list();
    int code_ = exit_code::done;
};

}  // namespace

int compare_pictures(const CompareRequest& request, std::ostream& out, std::ostream& err) {
    try {
        return Report(request, out, err).write();
    } catch (const Error& error) {
        err << "lightnet: " << error.what() << '\n';
        return exit_code::usage;
    }
}

}  // namespace lightnet
