// TIFF, with libtiff: whole numbers of 8 to 32 bits, floats and logarithms of brightness, in strips or tiles; whatever
// else there is, as libtiff turns it into 8 bits.
#include <half.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

// Of fax, which has a bit for each row that is like the one above, and of younger kinds; and of those in use.
constexpr std::int64_t pixels_per_byte = 1 << 16, pixels_per_byte_in_use = 4096;

std::int64_t pixels_per_byte_of(TIFF* tiff) {
    std::uint16_t kind = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &kind);
    for (const int known : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_JPEG, COMPRESSION_ADOBE_DEFLATE,
                            COMPRESSION_DEFLATE, COMPRESSION_PACKBITS})
        if (kind == known) return pixels_per_byte_in_use;
    return pixels_per_byte;
}

struct TiffBytes {
    Input bytes;
    std::size_t at = 0;
};

tmsize_t read_some(thandle_t handle, void* into, tmsize_t wanted) {
    auto& source = *static_cast<TiffBytes*>(handle);
    const auto count = std::min(static_cast<std::size_t>(std::max<tmsize_t>(0, wanted)),
                                source.bytes.size() - std::min(source.at, source.bytes.size()));
    if (count) std::memcpy(into, source.bytes.data() + source.at, count);
    source.at += count;
    return static_cast<tmsize_t>(count);
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t) { return 0; }

toff_t seek(thandle_t handle, toff_t to, int from) {
    auto& source = *static_cast<TiffBytes*>(handle);
    const std::size_t base = from == SEEK_CUR ? source.at : from == SEEK_END ? source.bytes.size() : 0;
    source.at = base + to;
    return source.at;
}

int close_nothing(thandle_t) { return 0; }
toff_t size_of(thandle_t handle) { return static_cast<TiffBytes*>(handle)->bytes.size(); }

int note(TIFF*, void* said, const char*, const char* format, va_list values) {
    char text[256] = "";
    std::vsnprintf(text, sizeof text, format, values);
    auto& first = *static_cast<std::string*>(said);
    if (first.empty()) first = text;
    return 1;  // nothing is to be printed
}

int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }

/// An open file; what it says of mistakes is kept.
class OpenTiff {
public:
    explicit OpenTiff(Input bytes) : source_{bytes} {
        const tmsize_t most_at_once =
            std::min(tmsize_t{1} << 30, (tmsize_t{64} << 20) + 1024 * static_cast<tmsize_t>(bytes.size()));
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
        TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), most_at_once);
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), note, &said_);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
        tiff_ = TIFFClientOpenExt("image", "rm", &source_, read_some, write_nothing, seek, close_nothing, size_of,
                                  nullptr, nullptr, options.get());
        must(tiff_);
    }
    OpenTiff(const OpenTiff&) = delete;
    OpenTiff& operator=(const OpenTiff&) = delete;
    ~OpenTiff() {
        if (tiff_) TIFFClose(tiff_);
    }
    operator TIFF*() const { return tiff_; }
    void must(bool good) const {
        if (!good) throw Error("TIFF: " + (said_.empty() ? "the file is broken, or ends early" : said_));
    }

private:
    TiffBytes source_;
    std::string said_;
    TIFF* tiff_ = nullptr;
};

struct Layout {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 1, channels = 1, format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG,
                  colours = PHOTOMETRIC_MINISBLACK;
    /// Do its samples stand as we keep them, or nearly so?
    bool plain() const {
        const bool whole =
            (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT) && (bits == 8 || bits == 16 || bits == 32);
        const bool rgb = colours == PHOTOMETRIC_RGB && (channels == 3 || channels == 4);
        const bool grey = colours == PHOTOMETRIC_MINISBLACK && channels <= 2;
        return (whole || floats()) && (rgb || grey || (logarithms() && floats()));
    }
    /// SGI's: of the brightness alone, or with colours. libtiff turns them into floats: Y, or X, Y and Z.
    bool logarithms() const {
        return (colours == PHOTOMETRIC_LOGL && channels == 1) || (colours == PHOTOMETRIC_LOGLUV && channels == 3);
    }
    /// Do they stand colour by colour?
    bool apart() const { return planes == PLANARCONFIG_SEPARATE && channels > 1; }
    bool floats() const { return format == SAMPLEFORMAT_IEEEFP && (bits == 16 || bits == 32 || bits == 64); }
    std::size_t row() const { return std::size_t{width} * channels * bits / 8; }
};

Layout layout_of(TIFF* tiff) {
    Layout found;
    std::uint16_t kind = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &kind);
    if (kind == COMPRESSION_SGILOG || kind == COMPRESSION_SGILOG24)
        TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &found.width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &found.height);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &found.bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &found.channels);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &found.format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &found.planes);
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &found.colours);
    return found;
}

/// The samples of one plane, of `pixel` bytes for each pixel, in the order of this machine, row by row.
std::vector<std::uint8_t> plane_of(const OpenTiff& tiff, const Layout& layout, std::size_t pixel, std::uint16_t plane) {
    const std::size_t length = layout.width * pixel;
    std::vector<std::uint8_t> rows(length * layout.height);
    if (!TIFFIsTiled(tiff)) {
        tiff.must(static_cast<std::size_t>(TIFFScanlineSize64(tiff)) == length);
        for (std::uint32_t y = 0; y < layout.height; ++y)
            tiff.must(TIFFReadScanline(tiff, rows.data() + y * length, y, plane) == 1);
        return rows;
    }
    std::uint32_t width = 0, height = 0;
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &height);
    check_size(width, height);
    std::vector<std::uint8_t> tile(pixel * width * height);
    tiff.must(static_cast<std::size_t>(TIFFTileSize64(tiff)) == tile.size());
    for (std::uint32_t y = 0; y < layout.height; y += height)
        for (std::uint32_t x = 0; x < layout.width; x += width) {
            tiff.must(TIFFReadTile(tiff, tile.data(), x, y, 0, plane) >= 0);
            const std::size_t across = std::min(width, layout.width - x), down = std::min(height, layout.height - y);
            for (std::size_t row = 0; row < down; ++row)
                std::memcpy(rows.data() + (y + row) * length + x * pixel, tile.data() + row * width * pixel,
                            across * pixel);
        }
    return rows;
}

/// The samples of each pixel beside each other.
std::vector<std::uint8_t> rows_of(const OpenTiff& tiff, const Layout& layout) {
    const std::size_t sample = layout.bits / 8, pixel = sample * layout.channels;
    if (!layout.apart()) return plane_of(tiff, layout, pixel, 0);
    std::vector<std::uint8_t> rows(layout.row() * layout.height);
    for (std::uint16_t channel = 0; channel < layout.channels; ++channel) {
        const auto plane = plane_of(tiff, layout, sample, channel);
        for (std::size_t i = 0; i * sample < plane.size(); ++i)
            std::memcpy(&rows[i * pixel + channel * sample], &plane[i * sample], sample);
    }
    return rows;
}

template <class From, class To>
std::vector<std::uint8_t> each(const std::vector<std::uint8_t>& rows, To (*turn)(From)) {
    const std::size_t count = rows.size() / sizeof(From);
    std::vector<std::uint8_t> turned(count * sizeof(To));
    for (std::size_t i = 0; i < count; ++i) {
        From from;
        std::memcpy(&from, rows.data() + i * sizeof from, sizeof from);
        const To to = turn(from);
        std::memcpy(turned.data() + i * sizeof to, &to, sizeof to);
    }
    return turned;
}

/// Rare kinds of samples, brought to bytes and words without a sign and to floats of 32 bits. Black is 0: what is below
/// it is black.
void bring_to_usual(Layout& layout, std::vector<std::uint8_t>& rows) {
    const bool real = layout.floats(), has_sign = layout.format == SAMPLEFORMAT_INT;
    if (real && layout.bits == 16)
        rows = each<std::uint16_t, float>(rows, [](std::uint16_t bits) { return imath_half_to_float(bits); });
    else if (real && layout.bits == 64)
        rows = each<double, float>(rows, [](double number) { return float(number); });
    else if (has_sign && layout.bits == 8)
        rows = each<std::int8_t, std::uint8_t>(
            rows, [](std::int8_t number) { return std::uint8_t(std::max(0, int{number}) * 255 / 127); });
    else if (has_sign && layout.bits == 16)
        rows = each<std::int16_t, std::uint16_t>(
            rows, [](std::int16_t number) { return std::uint16_t(std::max(0, int{number}) * 65535 / 32767); });
    else if (has_sign && layout.bits == 32)
        rows = each<std::int32_t, std::uint16_t>(
            rows, [](std::int32_t number) { return std::uint16_t(std::max(0, number) >> 15); });
    else if (!real && layout.bits == 32)
        rows =
            each<std::uint32_t, std::uint16_t>(rows, [](std::uint32_t number) { return std::uint16_t(number >> 16); });
    if (real) layout.bits = 32;
    if (!real && layout.bits == 32) layout.bits = 16;
}

Image image_of_floats(const Layout& layout, const std::vector<std::uint8_t>& rows) {
    const std::size_t count = std::size_t{layout.width} * layout.height, channels = layout.channels;
    std::vector<Rgb> pixels(count);
    std::vector<float> alpha(channels % 2 == 0 ? count : 0);
    for (std::size_t i = 0; i < count; ++i) {
        float number[4] = {};
        std::memcpy(number, rows.data() + i * channels * sizeof(float), channels * sizeof(float));
        pixels[i] = channels > 2 ? Rgb{number[0], number[1], number[2]} : Rgb{number[0], number[0], number[0]};
        if (!alpha.empty()) alpha[i] = number[channels - 1];
    }
    if (layout.colours == PHOTOMETRIC_LOGLUV) turn_to_ours(cie_xyz, pixels);
    return {layout.width, layout.height, pixels, alpha};
}

Raster raster_of(const Layout& layout, std::vector<std::uint8_t> rows) {
    Raster raster{layout.width, layout.height, layout.channels, layout.bits == 16, std::move(rows)};
    if (raster.wide && std::endian::native == std::endian::little)
        for (std::size_t i = 0; i + 1 < raster.bytes.size(); i += 2) std::swap(raster.bytes[i], raster.bytes[i + 1]);
    return raster;
}

// Palettes, few bits, CMYK, YCbCr.
Raster turned_into_eight_bits(const OpenTiff& tiff, const Layout& layout) {
    char why[1024] = "";
    if (!TIFFRGBAImageOK(tiff, why)) throw Error("TIFF: " + std::string(why));
    std::vector<std::uint32_t> pixels(std::size_t{layout.width} * layout.height);
    std::uint16_t turned = ORIENTATION_TOPLEFT;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION,
                          &turned);  // asked for as it stands there, so that nothing turns it
    tiff.must(TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, pixels.data(), turned, 1) == 1);
    Raster raster{layout.width, layout.height, 3, false, {}};
    raster.bytes.reserve(pixels.size() * 3);
    for (const std::uint32_t pixel : pixels)
        for (const auto value : {TIFFGetR(pixel), TIFFGetG(pixel), TIFFGetB(pixel)})
            raster.bytes.push_back(static_cast<std::uint8_t>(value));
    return raster;
}

}  // namespace

Found read_tiff(Input bytes) {
    const OpenTiff tiff(bytes);
    Layout layout = layout_of(tiff);
    check_size(layout.width, layout.height, bytes, pixels_per_byte_of(tiff));
    if (!layout.plain()) return turned_into_eight_bits(tiff, layout);
    auto rows = rows_of(tiff, layout);
    bring_to_usual(layout, rows);
    if (layout.floats()) return image_of_floats(layout, rows);
    return raster_of(layout, std::move(rows));
}

}  // namespace lightnet::decoders
