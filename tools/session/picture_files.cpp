#include "tools/session/picture_files.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/spare_threads.hpp"
#include "core/film/clean/clean.hpp"
#include "core/film/exr.hpp"
#include "core/film/npz.hpp"
#include "core/film/png.hpp"
#include "tools/pictures/clean.hpp"
#include "tools/session/run_figures.hpp"

namespace lightnet {
namespace {

// For whoever waits for it: both at once, and nobody waits for the disk.
void write_quickly(const std::string& exr, const std::filesystem::path& png, const Picture& picture,
                   const PngView& view) {
    auto written = in_background([&] { write_file_unsynced(exr, exr_of(picture)); });
    write_file_unsynced(png, png_of(picture, view, PngEffort::quick));
    written.get();
}

// False also where there is no such file.
bool holds(const std::string& file, const std::string& bytes) try {
    return PlainFile(file, bytes.size()).text() == bytes;
} catch (const Error&) {
    return false;
}

}  // namespace

bool PictureFiles::is_there(const std::string& exr) const { return holds(exr, exr_of(now())); }

Picture PictureFiles::now() const {
    Picture picture = steps_.picture().picture(scale_);
    add_words(words_, picture);
    const FilmFormat& format = steps_.picture().format();
    picture.notes.texts[samples_note] =
        fmt::format("{:.10g}", format.coarse ? steps_.picture().mean_samples() : format.samples);
    return picture;
}

void PictureFiles::write(const std::string& exr, bool quickly) {
    const auto png = png_beside(exr);
    expect_ours(exr, exr_beginning);
    expect_ours(png, png_beginning);
    auto& report = account_.report();
    auto picture = now();
    if (quickly) picture.storage.compression = lossless_compressions().front();
    if (picture.overflowed && !std::exchange(said_overflow_, true))
        account_.alert(fmt::format("{} pixels are brighter than the numbers of a picture can be, and count as black",
                                   picture.overflowed));
    if (!quickly) apart([&] { write_exr(exr, picture); });
    if (!quickly) written_.insert(exr);  // whatever becomes of the other
    png_.brightness = brightness_of(picture, png_.request.stops.value_or(0));
    const PngView view = png_view(png_.request, png_.brightness, png_.exposed);
    apart([&] { quickly ? write_quickly(exr, png, picture, view) : write_png(png, picture, view); });
    written_.insert(exr);
    png_.stops = view.stops;
    if (!quickly) report.layers = light_of_layers(picture);
    report.outputs = {exr, png.string()};
    if (!arrays_.empty()) {
        expect_ours(arrays_, npz_beginning);
        apart([&] { write_npz(arrays_, picture); });
        report.outputs.push_back(arrays_);
    }
    report.settings["tone of the PNG"] = tone_of(view);
}

void PictureFiles::write_clean(const std::string& exr) {
    const auto begun = std::chrono::steady_clock::now();
    const auto file = clean_beside(exr);
    expect_ours(file, exr_beginning);
    expect_ours(png_beside(file), png_beginning);
    const Cleaned cleaned = clean(now());
    for (const auto& lack : cleaned.lacks) account_.alert(file + " could be better: " + lack);
    write_exr(file, cleaned.picture);
    write_png(png_beside(file), cleaned.picture, png_view(png_.request, png_.brightness, png_.exposed));
    auto& report = account_.report();
    report.outputs.insert(report.outputs.end(), {file, png_beside(file).string()});
    if (!arrays_.empty()) {
        const auto arrays = clean_beside(arrays_);
        expect_ours(arrays, npz_beginning);
        write_npz(arrays, cleaned.picture);
        report.outputs.push_back(arrays);
    }
    report.settings["clean"] =
        fmt::format("{:.2f} s", std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
}

}  // namespace lightnet
