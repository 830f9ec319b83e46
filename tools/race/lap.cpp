#include "tools/race/lap.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/plain_file.hpp"
#include "core/film/compare.hpp"
#include "core/film/compare_layers.hpp"
#include "core/film/exr.hpp"
#include "core/film/flip.hpp"
#include "core/film/png.hpp"
#include "core/film/tone.hpp"
#include "tools/pictures/compare.hpp"
#include "tools/pictures/error_curve.hpp"
#include "tools/pictures/picture_input.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t longest_file = std::uint64_t{256} << 20;

std::string text_in(const fs::path& file) { return PlainFile(file, longest_file).text(); }

double number_in(std::string_view text) {
    double number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

// The lines of an ErrorCurve's file.
std::vector<LapPoint> curve_in(const fs::path& csv) {
    std::vector<LapPoint> points;
    std::istringstream lines(text_in(csv));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream in(line);
        LapPoint point;
        std::string part;
        for (double* number : {&point.samples, &point.seconds, &point.relative_square, &point.square})
            if (std::getline(in, part, ',')) *number = number_in(part);
        points.push_back(point);
    }
    return points;
}

// Preparing and rendering, of a report.
double seconds_in(const Json& report) {
    double seconds = 0;
    for (const auto& phase : report.at("phases").list())
        if (const auto& name = phase.at("name").text(); name == "prepare" || name == "render")
            seconds += phase.at("seconds").number();
    return seconds;
}

double samples_in(const Json& report) {
    const Json& settings = report.at("settings");
    return number_in(settings.at(settings.has("mean_samples") ? "mean_samples" : "samples").text());
}

double worst_bias(const Rgb& ratio) {
    return std::max({std::fabs(ratio.r - 1.0), std::fabs(ratio.g - 1.0), std::fabs(ratio.b - 1.0)});
}

}  // namespace

Track::Track(std::function<int(const RunRequest&)> run, const std::string& reference)
    : run_(std::move(run)), reference_(reference) {
    if (!reference.empty()) truth_ = picture_of_user(reference);
}

Lap Track::lap(const Contestant& contestant, std::uint64_t seed, bool pictures) {
    RunRequest request = contestant.request;
    const fs::path picture = fs::path(folder_.path()) / "picture.exr", csv = fs::path(folder_.path()) / "curve.csv";
    request.output = picture.string();
    request.seed = seed;
    request.forget = true;
    request.memo = false;
    request.progress = ProgressMode::none;
    request.reference = reference_;
    if (truth_) request.curve = csv.string();
    const int code = run_(request);
    if (code == exit_code::interrupted) throw Interrupted{};
    if (code != exit_code::done) throw Error(contestant.name, "its run ended with code " + std::to_string(code));
    const Json report = parse_json(text_in(report_beside(picture)), {.depth = 64});
    Lap lap{contestant.name, seed, samples_in(report), seconds_in(report)};
    if (truth_) lap.curve = curve_in(csv);
    measure(lap, read_exr(picture), pictures);
    return lap;
}

void Track::measure(Lap& lap, const Picture& picture, bool pictures) const {
    if (pictures) lap.png = png_of(picture, png_view({}, brightness_of(picture)));
    if (!truth_) return;
    const Difference found = compare(*truth_, picture);
    const Flip seen = flip(picture.width, truth_->beauty, picture.beauty);
    lap.error = {found.relative_square, found.mean_square, found.block_difference, seen.mean,
                 worst_bias(found.mean_ratio)};
    if (pictures) lap.flip_png = png_of(magma_of(picture.width, seen.map));
}

std::string Track::reference_png() const { return truth_ ? png_of(*truth_, png_view({}, brightness_of(*truth_))) : ""; }

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

}  // namespace lightnet
