#include "tools/pictures/film_strip.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/frame_name.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/own_files.hpp"
#include "core/film/exr.hpp"
#include "tools/pictures/output_file.hpp"
#include "transport/start/child.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t cell_side = 240, sheet_margin = 4;  // of a sheet, pixels
constexpr auto longest_encoding = std::chrono::hours(24);

Picture picture_of_frame(const std::string& file) {
    try {
        return read_exr(file);
    } catch (const Error& error) {
        throw UserError({file, 0}, error.what());
    }
}

/// The number that stands in a name where a pattern has a place for it.
std::optional<int> number_in(const std::string& name, const std::string& pattern) {
    for (std::size_t begin = 0; begin < name.size(); ++begin) {
        const std::string_view digits(name.data() + begin, name.size() - begin);
        const auto count = std::min(digits.find_first_not_of("0123456789"), digits.size());
        if (count == 0 || count > 8 || (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1]))))
            continue;
        const int number = std::atoi(std::string(digits.substr(0, count)).c_str());
        if (with_frame(pattern, number) == name) return number;
    }
    return std::nullopt;
}

/// The mean of what a pixel of the sheet covers, clipped as it is shown.
Rgb mean(const Picture& picture, std::uint32_t x, std::uint32_t y, double scale, float gain) {
    const auto range = [&](std::uint32_t at, std::uint32_t size) {
        const auto first = std::min(static_cast<std::uint32_t>(at * scale), size - 1);
        return std::pair(first, std::clamp(static_cast<std::uint32_t>((at + 1) * scale), first + 1, size));
    };
    const auto [left, right] = range(x, picture.width);
    const auto [top, bottom] = range(y, picture.height);
    Rgb sum;
    for (std::uint32_t j = top; j < bottom; ++j)
        for (std::uint32_t i = left; i < right; ++i) {
            const Rgb c = picture.beauty[std::size_t{j} * picture.width + i] * gain;
            sum += Rgb{std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f)};
        }
    return sum / static_cast<float>((right - left) * (bottom - top));
}

void lay(Picture& sheet, std::uint32_t left, std::uint32_t top, const Picture& picture, float gain) {
    const double scale = std::max(1.0, double(std::max(picture.width, picture.height)) / cell_side);
    const auto width = std::clamp(static_cast<std::uint32_t>(picture.width / scale), 1u, cell_side);
    const auto height = std::clamp(static_cast<std::uint32_t>(picture.height / scale), 1u, cell_side);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            sheet.beauty[std::size_t{top + y} * sheet.width + left + x] = mean(picture, x, y, scale, gain);
}

// Of all, before the first is written.
void expect_strip_place(const std::vector<FrameFile>& frames, const std::string& name) {
    std::set<fs::path> own;
    for (const auto& frame : frames) own.insert(png_beside(frame.file));
    for (std::size_t place = 1; place <= frames.size(); ++place) {
        const auto png = with_frame(name, static_cast<int>(place));
        if (own.contains(png))
            throw UserError({png, 0},
                            "is the picture beside a frame: give those of the film another name, like film.####.png");
        expect_ours(png, png_beginning);
    }
}

bool is_in_path(const std::string& program) {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    std::error_code none;
    for (std::string folder; std::getline(folders, folder, ':');)
        if (fs::is_regular_file(fs::path(folder) / program, none)) return true;
    return false;
}

}  // namespace

std::vector<FrameFile> frame_files(const std::string& pattern) {
    if (!has_frame_place(pattern)) {
        const auto better = frame_place_for(pattern);
        throw UserError({pattern, 0}, "has no place for the numbers of frames; they are named like " +
                                          (better.empty() ? "shot.####.exr" : better));
    }
    const fs::path path(pattern);
    const auto folder = path.parent_path(), name = path.filename();
    std::vector<FrameFile> frames;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, none))
        if (const auto number = number_in(entry.path().filename().string(), name.string()))
            frames.push_back({*number, with_frame(pattern, *number)});
    if (frames.empty()) throw UserError({pattern, 0}, "there is no file of such a name");
    std::sort(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
    return frames;
}

std::vector<FrameFile> frame_files(const std::string& pattern, const std::vector<int>& wanted) {
    auto files = frame_files(pattern);
    if (wanted.empty()) return files;
    std::erase_if(files, [&](const FrameFile& file) { return std::ranges::find(wanted, file.number) == wanted.end(); });
    if (files.empty()) throw UserError({pattern, 0}, "none of these frames is there");
    return files;
}

std::string missing_frames(const std::vector<FrameFile>& frames) {
    std::string text;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
        const int first = frames[i].number + 1, last = frames[i + 1].number - 1;
        if (first > last) continue;
        text += (text.empty() ? "" : ", ") + std::to_string(first);
        if (last > first) text += "-" + std::to_string(last);
    }
    return text;
}

PngView view_of_film(const std::vector<FrameFile>& frames, const PngRequest& wanted) {
    return png_view(wanted, brightness_of(picture_of_frame(frames.front().file)));
}

void write_strip(const std::vector<FrameFile>& frames, const PngView& view, const std::string& name) {
    expect_strip_place(frames, name);
    std::optional<std::pair<std::uint32_t, std::uint32_t>> size;
    int place = 0;
    for (const auto& frame : frames) {
        const auto picture = picture_of_frame(frame.file);
        if (!size) size = {picture.width, picture.height};
        if (*size != std::pair(picture.width, picture.height))
            throw UserError({frame.file, 0},
                            fmt::format("has {}x{} pixels, and {} has {}x{}", picture.width, picture.height,
                                        frames.front().file, size->first, size->second));
        write_png(with_frame(name, ++place), picture, view);
    }
}

void write_sheet(const std::vector<FrameFile>& frames, const PngView& view, const fs::path& png) {
    expect_ours(png, png_beginning);
    const auto count = static_cast<std::uint32_t>(frames.size());
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(double(count))));
    const std::uint32_t rows = (count + columns - 1) / columns;
    const auto first = picture_of_frame(frames.front().file);
    const double scale = std::max(1.0, double(std::max(first.width, first.height)) / cell_side);
    const auto width = static_cast<std::uint32_t>(first.width / scale) + sheet_margin;
    const auto height = static_cast<std::uint32_t>(first.height / scale) + sheet_margin;
    Picture sheet;
    sheet.width = columns * width + sheet_margin;
    sheet.height = rows * height + sheet_margin;
    sheet.beauty.resize(std::size_t{sheet.width} * sheet.height);
    const auto gain = static_cast<float>(std::exp2(view.stops));
    for (std::uint32_t i = 0; i < count; ++i)
        lay(sheet, sheet_margin + i % columns * width, sheet_margin + i / columns * height,
            picture_of_frame(frames[i].file), gain);
    write_png(png, sheet, {0, view.tone, view.ocio});
}

void expect_film_place(const fs::path& film) {
    if (has_ending(film, ".mp4") || has_ending(film, ".mov")) return expect_ours(film, "ftyp", 4);
    expect_ours(film, has_ending(film, ".gif") ? "GIF8" : "\x1a\x45\xdf\xa3");  // Matroska and WebM
}

bool encode_film(const std::string& strip, double fps, const std::string& film) {
    if (!is_in_path("ffmpeg")) return false;
    const fs::path path(film);
    const auto part =
        path.parent_path() / fmt::format(".{}.{}.part{}", path.stem().string(), ::getpid(), path.extension().string());
    std::vector<std::string> words{"ffmpeg",
                                   "-hide_banner",
                                   "-loglevel",
                                   "error",
                                   "-y",
                                   "-framerate",
                                   fmt::format("{:g}", fps),
                                   "-i",
                                   strip,
                                   "-pix_fmt",
                                   "yuv420p",
                                   "-vf",
                                   "pad=ceil(iw/2)*2:ceil(ih/2)*2"};  // which most players want
    if (path.extension() == ".mp4" || path.extension() == ".mov")
        words.insert(words.end(), {"-c:v", "libx264", "-crf", "16", "-movflags", "+faststart"});
    words.push_back(part.string());
    const auto ended = run_program(std::move(words), "", longest_encoding);
    std::error_code none;
    if (ended.code != 0) fs::remove(part, none);
    if (ended.code != 0) throw Error("ffmpeg", "ended with " + std::to_string(ended.code) + ": " + ended.text);
    fs::rename(part, path);
    return true;
}

}  // namespace lightnet
