#include "tests/support/picture_bytes.hpp"

#include <cstdio>  // jpeglib.h needs it

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <jpeglib.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace lightnet::test {
namespace {

class Memory final : public Imf::OStream {
public:
    Memory() : Imf::OStream("test") {}
    void write(const char bytes[], int count) override {
        if (bytes_.size() < at_ + static_cast<std::size_t>(count)) bytes_.resize(at_ + static_cast<std::size_t>(count));
        std::memcpy(bytes_.data() + at_, bytes, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

struct TiffFile {
    std::string bytes;
    std::size_t at = 0;
};

tmsize_t read_tiff(thandle_t handle, void* into, tmsize_t wanted) {
    auto& file = *static_cast<TiffFile*>(handle);
    const auto count =
        std::min<std::size_t>(std::size_t(wanted), file.bytes.size() - std::min(file.at, file.bytes.size()));
    std::memcpy(into, file.bytes.data() + file.at, count);
    file.at += count;
    return tmsize_t(count);
}

tmsize_t write_tiff(thandle_t handle, void* from, tmsize_t count) {
    auto& file = *static_cast<TiffFile*>(handle);
    file.bytes.resize(std::max(file.bytes.size(), file.at + std::size_t(count)));
    std::memcpy(file.bytes.data() + file.at, from, std::size_t(count));
    file.at += std::size_t(count);
    return count;
}

toff_t seek_tiff(thandle_t handle, toff_t to, int from) {
    auto& file = *static_cast<TiffFile*>(handle);
    return file.at = std::size_t(to) + (from == SEEK_CUR ? file.at : from == SEEK_END ? file.bytes.size() : 0);
}

// What `fill` writes into one of that size.
template <class Fill>
std::string tiff_of(std::uint32_t width, std::uint32_t height, std::uint16_t bits, Fill fill) {
    TiffFile file;
    TIFF* tiff = TIFFClientOpen(
        "test", "w", &file, read_tiff, write_tiff, seek_tiff, [](thandle_t) { return 0; },
        [](thandle_t handle) -> toff_t { return static_cast<TiffFile*>(handle)->bytes.size(); }, nullptr, nullptr);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
    fill(tiff);
    TIFFClose(tiff);
    return file.bytes;
}

std::vector<std::uint8_t> tiff_pixel(int bits, std::uint32_t x, std::uint32_t y) {
    std::vector<std::uint8_t> pixel;
    for (const std::uint32_t number : {x, y, 1u}) {
        const float real = float(number);
        std::uint8_t raw[4] = {};
        std::memcpy(raw, bits == 32 ? static_cast<const void*>(&real) : &number, std::size_t(bits) / 8);
        pixel.insert(pixel.end(), raw, raw + bits / 8);
    }
    return pixel;
}

}  // namespace

std::string tiff(int bits, bool tiles, bool apart) {
    constexpr std::uint32_t width = 20, height = 18, tile = 16;
    return tiff_of(width, height, std::uint16_t(bits), [&](TIFF* file) {
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 3);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
        if (bits == 32) TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
        if (tiles) TIFFSetField(file, TIFFTAG_TILEWIDTH, tile), TIFFSetField(file, TIFFTAG_TILELENGTH, tile);
        if (apart) TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_SEPARATE);
        const std::size_t sample = std::size_t(bits) / 8;
        for (std::uint16_t plane = 0; plane < (apart ? 3 : 1); ++plane) {
            const auto pixels_of = [&](std::uint32_t first, std::uint32_t y, std::uint32_t count) {
                std::vector<std::uint8_t> row;
                for (std::uint32_t x = first; x < first + count; ++x) {
                    const auto pixel = tiff_pixel(bits, x, y);
                    const auto from = pixel.begin() + std::ptrdiff_t(plane * sample);
                    row.insert(row.end(), from, apart ? from + std::ptrdiff_t(sample) : pixel.end());
                }
                return row;
            };
            for (std::uint32_t y = 0; y < height && !tiles; ++y)
                TIFFWriteScanline(file, pixels_of(0, y, width).data(), y, plane);
            for (std::uint32_t y = 0; y < height && tiles; y += tile)
                for (std::uint32_t x = 0; x < width; x += tile) {
                    std::vector<std::uint8_t> all;
                    for (std::uint32_t row = y; row < y + tile; ++row)
                        for (const auto byte : pixels_of(x, row, tile)) all.push_back(byte);
                    TIFFWriteTile(file, all.data(), x, y, 0, plane);
                }
        }
    });
}

std::string grey_tiff(int bits, int format, const std::string& samples) {
    return tiff_of(2, 1, std::uint16_t(bits), [&](TIFF* file) {
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, format);
        std::string row = samples;
        TIFFWriteScanline(file, row.data(), 0, 0);
    });
}

std::string log_tiff(int compression, std::vector<float> pixels) {
    const bool grey = pixels.size() == 2;
    return tiff_of(2, 1, 32, [&](TIFF* file) {
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, grey ? 1 : 3);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, grey ? PHOTOMETRIC_LOGL : PHOTOMETRIC_LOGLUV);
        TIFFSetField(file, TIFFTAG_COMPRESSION, compression);
        TIFFSetField(file, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
        TIFFWriteScanline(file, pixels.data(), 0, 0);
    });
}

std::string palette_tiff(int turned) {
    return tiff_of(2, 1, 8, [turned](TIFF* file) {
        TIFFSetField(file, TIFFTAG_ORIENTATION, turned);
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_PALETTE);
        std::vector<std::uint16_t> red(256), green(256), blue(256);
        red[0] = 65535, blue[2] = 128 * 257;
        TIFFSetField(file, TIFFTAG_COLORMAP, red.data(), green.data(), blue.data());
        std::uint8_t row[] = {0, 2};
        TIFFWriteScanline(file, row, 0, 0);
    });
}

std::string tga(int bits, bool packed) {
    std::string file(18, '\0');
    file[2] = static_cast<char>((bits == 8 ? 3 : 2) + (packed ? 8 : 0));
    file[12] = 3, file[14] = 2, file[16] = static_cast<char>(bits);
    file[17] = static_cast<char>(bits == 32 ? 8 : 0);
    const auto pixel = [&](int r, int g, int b, int a) {
        if (bits == 8) return std::string(1, char(r));
        if (bits == 16) {
            const int word = r / 8 << 10 | g / 8 << 5 | b / 8;
            return std::string{char(word & 255), char(word >> 8)};
        }
        const std::string bgr{char(b), char(g), char(r)};
        return bits == 32 ? bgr + char(a) : bgr;
    };
    // from the lowest row
    const std::string all[] = {pixel(255, 255, 255, 255), pixel(128, 128, 128, 255), pixel(0, 0, 0, 255),
                               pixel(255, 0, 0, 255),     pixel(0, 255, 0, 255),     pixel(0, 0, 255, 128)};
    for (int i = 0; i < 6; ++i) {
        if (packed && i < 2) file += char(i == 0 ? 0x80 : 4);  // a run of one, then five as they are
        file += all[i];
    }
    return file;
}

std::string png(std::uint32_t format, const void* samples) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2, image.height = 1, image.format = format;
    png_alloc_size_t size = 0;
    png_image_write_to_memory(&image, nullptr, &size, 0, samples, 0, nullptr);
    std::string bytes(size, '\0');
    png_image_write_to_memory(&image, bytes.data(), &size, 0, samples, 0, nullptr);
    bytes.resize(size);
    return bytes;
}

std::string small_png() {
    const std::uint8_t samples[] = {255, 0, 188, 0, 255, 128};
    return png(PNG_FORMAT_RGB, samples);
}

std::string jpeg(std::uint8_t value, int channels) {
    jpeg_compress_struct c;
    jpeg_error_mgr errors;
    c.err = jpeg_std_error(&errors);
    jpeg_create_compress(&c);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&c, &memory, &size);
    c.image_width = 16, c.image_height = 8, c.input_components = channels;
    c.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&c);
    jpeg_set_quality(&c, 100, TRUE);
    jpeg_start_compress(&c, TRUE);
    std::vector<std::uint8_t> row(16u * static_cast<unsigned>(channels), value);
    JSAMPROW pointer = row.data();
    while (c.next_scanline < c.image_height) jpeg_write_scanlines(&c, &pointer, 1);
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    std::string bytes(reinterpret_cast<char*>(memory), size);
    std::free(memory);
    return bytes;
}

std::string exr(const std::vector<std::string>& channels) {
    Memory memory;
    {
        Imf::Header header(3, 2);
        Imf::FrameBuffer buffer;
        static std::vector<std::vector<float>> planes;
        planes.assign(channels.size(), {0.25f, 1, 2, 3, 4, 1000});
        for (std::size_t i = 0; i < channels.size(); ++i) {
            header.channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
            for (float& value : planes[i]) value += float(i);
            buffer.insert(channels[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(planes[i].data()), sizeof(float),
                                                  3 * sizeof(float)));
        }
        Imf::OutputFile file(memory, header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    return memory.bytes();
}

std::string tiled_exr() {
    Memory memory;
    {
        constexpr int width = 70, height = 50;
        Imf::Header header(width, height);
        header.setTileDescription(Imf::TileDescription(32, 32, Imf::MIPMAP_LEVELS));
        for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        Imf::TiledOutputFile file(memory, header);
        for (int level = 0; level < file.numLevels(); ++level) {
            const int wide = file.levelWidth(level), high = file.levelHeight(level);
            std::vector<float> values;
            for (int y = 0; y < high; ++y)
                for (int x = 0; x < wide; ++x) values.insert(values.end(), {float(x), float(y), level ? 9.0f : 1.0f});
            Imf::FrameBuffer buffer;
            for (int c = 0; c < 3; ++c)
                buffer.insert(c == 0   ? "R"
                              : c == 1 ? "G"
                                       : "B",
                              Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c), 3 * sizeof(float),
                                         3 * sizeof(float) * static_cast<std::size_t>(wide)));
            file.setFrameBuffer(buffer);
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    return memory.bytes();
}

std::string hdr() {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
    text += std::string("\x02\x02\x00\x08", 4);
    for (const unsigned char value : {128, 64, 32, 129}) {
        text += static_cast<char>(128 + 8);
        text += static_cast<char>(value);
    }
    return text;
}

}  // namespace lightnet::test
