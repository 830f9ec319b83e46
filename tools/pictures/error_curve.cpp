#include "tools/pictures/error_curve.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/film/compare.hpp"
#include "tools/pictures/compare.hpp"
#include "tools/pictures/picture_input.hpp"

namespace lightnet {
namespace {

void check_curve(const std::string& csv) {
    if (csv.empty()) return;
    const auto folder = std::filesystem::path(csv).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
        throw UserError({csv, 0}, "there is no folder " + folder.string());
    if (const auto why = why_not_replaced(csv, curve_beginning); !why.empty()) throw UserError({csv, 0}, why);
}

}  // namespace

ErrorCurve::ErrorCurve(const std::string& reference, const std::string& csv, std::uint32_t width, std::uint32_t height)
    : name_(reference), csv_(csv), reference_(picture_of_user(reference)) {
    check_curve(csv);
    if (reference_.width != width || reference_.height != height)
        throw UserError({reference, 0}, fmt::format("is of {}x{} pixels, and the picture of {}x{}", reference_.width,
                                                    reference_.height, width, height));
}

void ErrorCurve::note(double samples, double seconds, const Picture& picture) {
    const Difference found = compare(reference_, picture);
    last_ = {name_, samples, found.relative_square, found.mean_square};
    lines_ += fmt::format("{:g},{:.3f},{:.6g},{:.6g}\n", samples, seconds, found.relative_square, found.mean_square);
    if (!csv_.empty()) write_file(csv_, lines_);
}

}  // namespace lightnet
