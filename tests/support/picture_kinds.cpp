#include "tests/support/picture_kinds.hpp"

#include <cstdio>  // jpeglib.h needs it

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <gif_lib.h>
#include <jpeglib.h>
#include <webp/encode.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace lightnet::test {
namespace {

class ExrBytes final : public Imf::OStream {
public:
    ExrBytes() : Imf::OStream("test") {}
    void write(const char bytes[], int count) override {
        if (bytes_.size() < at_ + std::size_t(count)) bytes_.resize(at_ + std::size_t(count));
        std::memcpy(bytes_.data() + at_, bytes, std::size_t(count));
        at_ += std::size_t(count);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

std::string low_first(std::uint64_t value, std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(i < 8 ? value >> (8 * i) : 0);
    return bytes;
}

std::string raw_float(float value, bool low) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    std::string bytes = low_first(bits, 4);
    if (!low) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// The numbers of a palette that a row of the wheel has.
const std::array<std::array<int, 3>, 2> wheel_numbers{{{0, 1, 2}, {3, 4, 5}}};

std::string bmp_row(int bits, std::uint32_t y) {
    std::string row;
    const auto all = Wheel::bytes(3);
    std::uint32_t word = 0;
    for (std::uint32_t x = 0; x < Wheel::width; ++x) {
        const std::uint8_t* p = &all[(y * Wheel::width + x) * 3];
        const int number = wheel_numbers[y][x];
        if (bits == 1) word |= (p[0] + p[1] + p[2] > 300 ? 1u : 0u) << (7 - x);
        if (bits == 4) word |= unsigned(number) << (x % 2 ? 8 * (x / 2) : 8 * (x / 2) + 4);
        if (bits == 8) row += char(number);
        if (bits == 16) row += low_first(unsigned(p[0] / 8) << 10 | unsigned(p[1] / 8) << 5 | p[2] / 8u, 2);
        if (bits >= 24) row += {char(p[2]), char(p[1]), char(p[0])};
        if (bits == 32) row += char(x == 2 && y == 0 ? 128 : 255);
    }
    if (bits < 8) row = low_first(word, bits == 1 ? 1 : 2);
    row.resize((row.size() + 3) / 4 * 4, '\0');
    return row;
}

std::string bmp_runs(int bits, std::uint32_t y) {
    const auto& numbers = wheel_numbers[y];
    if (bits == 8) return {1, char(numbers[0]), 1, char(numbers[1]), 1, char(numbers[2]), 0, 0};
    // as they are: three halves in two bytes
    return {0, 3, char(numbers[0] << 4 | numbers[1]), char(numbers[2] << 4), 0, 0};
}

}  // namespace

std::vector<std::uint8_t> Wheel::bytes(int channels) {
    const std::uint8_t all[6][4] = {{255, 0, 0, 255},     {0, 255, 0, 255},     {0, 0, 255, 128},
                                    {255, 255, 255, 255}, {128, 128, 128, 255}, {0, 0, 0, 255}};
    std::vector<std::uint8_t> bytes;
    for (const auto& pixel : all) bytes.insert(bytes.end(), pixel, pixel + channels);
    return bytes;
}

std::string bmp(int bits, bool from_top, bool packed) {
    const bool palette = bits <= 8, masks = packed && bits >= 16;
    std::string colours;
    if (bits == 1) colours = low_first(0, 4) + low_first(0xFFFFFF, 4);
    for (const auto all = Wheel::bytes(3); bits > 1 && palette && colours.size() < 24;) {
        const std::uint8_t* p = &all[colours.size() / 4 * 3];
        colours += {char(p[2]), char(p[1]), char(p[0]), 0};
    }
    if (masks)
        for (const unsigned mask :
             bits == 16 ? std::array{0x7C00u, 0x3E0u, 0x1Fu, 0u} : std::array{0xFF0000u, 0xFF00u, 0xFFu, 0xFF000000u})
            colours += low_first(mask, 4);
    std::string rows;
    for (std::uint32_t i = 0; i < Wheel::height; ++i) {
        const std::uint32_t y = from_top ? i : Wheel::height - 1 - i;
        rows += packed && palette ? bmp_runs(bits, y) : bmp_row(bits, y);
    }
    const unsigned packing = !packed ? 0 : masks ? 3 : bits == 8 ? 1 : 2;
    const std::uint32_t header = masks ? 56 : 40;
    const auto behind = std::uint32_t(14 + 40 + colours.size());
    return "BM" + low_first(behind + rows.size(), 4) + low_first(0, 4) + low_first(behind, 4) + low_first(header, 4) +
           low_first(Wheel::width, 4) + low_first(std::uint64_t(from_top ? -2 : 2), 4) + low_first(1, 2) +
           low_first(unsigned(bits), 2) + low_first(packing, 4) + low_first(rows.size(), 4) + low_first(0, 8) +
           low_first(palette ? colours.size() / 4 : 0, 4) + low_first(0, 4) + colours + rows;
}

std::string netpbm(char kind, unsigned most) {
    const bool bits = kind == '1' || kind == '4', letters = kind <= '3';
    const int channels = kind == '3' || kind == '6' ? 3 : kind == '7' ? 4 : 1;
    std::string text = std::string("P") + kind + "\n# a remark\n";
    if (kind == '7')
        text += "WIDTH 3\nHEIGHT 2\nDEPTH 4\nMAXVAL " + std::to_string(most) + "\nTUPLTYPE RGB_ALPHA\nENDHDR\n";
    else
        text += "3 2\n" + (bits ? "" : std::to_string(most) + "\n");
    if (kind == '4') return text + "\xA0\x40";  // black, white, black; white, black, white
    if (kind == '1') return text + "101 # more\n0 1 0\n";
    const auto all = Wheel::bytes(channels == 4 ? 4 : 3);
    for (std::size_t i = 0; i < all.size(); i += channels == 1 ? 3 : 1) {
        const unsigned value = all[i] * most / 255;
        if (letters) text += std::to_string(value) + (i % 2 ? "\n" : " ");
        if (!letters && most > 255) text += static_cast<char>(value >> 8);
        if (!letters) text += static_cast<char>(value);
    }
    return text;
}

std::string pfm(bool colours, float scale) {
    std::string text = std::string(colours ? "PF" : "Pf") + "\n3 2\n" + std::to_string(scale) + "\n";
    const auto all = Wheel::bytes(3);
    for (std::uint32_t row = Wheel::height; row-- > 0;)
        for (std::uint32_t x = 0; x < Wheel::width; ++x)
            for (std::uint32_t c = 0; c < (colours ? 3u : 1u); ++c)
                text += raw_float(float(all[(row * Wheel::width + x) * 3 + c]) / 255, scale < 0);
    return text;
}

std::string webp(bool lossless, bool alpha) {
    const auto all = Wheel::bytes(alpha ? 4 : 3);
    std::uint8_t* made = nullptr;
    std::size_t size = 0;
    const int wide = Wheel::width, high = Wheel::height;
    if (lossless)
        size = alpha ? WebPEncodeLosslessRGBA(all.data(), wide, high, wide * 4, &made)
                     : WebPEncodeLosslessRGB(all.data(), wide, high, wide * 3, &made);
    else
        size = alpha ? WebPEncodeRGBA(all.data(), wide, high, wide * 4, 100, &made)
                     : WebPEncodeRGB(all.data(), wide, high, wide * 3, 100, &made);
    const std::string bytes(reinterpret_cast<char*>(made), size);
    WebPFree(made);
    return bytes;
}

std::string gif(bool interlaced) {
    std::string bytes;
    const auto keep = [](GifFileType* file, const GifByteType* from, int count) {
        static_cast<std::string*>(file->UserData)->append(reinterpret_cast<const char*>(from), std::size_t(count));
        return count;
    };
    int problem = 0;
    GifFileType* file = EGifOpen(&bytes, keep, &problem);
    const auto all = Wheel::bytes(3);
    GifColorType colours[8] = {};
    for (int i = 0; i < 6; ++i)
        colours[i] = {all[std::size_t(3 * i)], all[std::size_t(3 * i + 1)], all[std::size_t(3 * i + 2)]};
    ColorMapObject* map = GifMakeMapObject(8, colours);
    EGifPutScreenDesc(file, Wheel::width, Wheel::height, 8, 0, map);
    const GraphicsControlBlock control{0, false, 0, 2};
    GifByteType extension[4];
    EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, int(EGifGCBToExtension(&control, extension)), extension);
    EGifPutImageDesc(file, 0, 0, Wheel::width, Wheel::height, interlaced, nullptr);
    GifPixelType rows[2][3] = {{0, 1, 2}, {3, 4, 5}};  // of two rows the order is the same
    for (auto& row : rows) EGifPutLine(file, row, 3);
    EGifCloseFile(file, &problem);
    GifFreeMapObject(map);
    return bytes;
}

std::string cmyk_jpeg(std::uint8_t c, std::uint8_t m, std::uint8_t y, std::uint8_t k, bool adobe) {
    jpeg_compress_struct jpeg;
    jpeg_error_mgr errors;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = jpeg.image_height = 8, jpeg.input_components = 4, jpeg.in_color_space = JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, adobe ? JCS_YCCK : JCS_CMYK);
    jpeg.write_Adobe_marker = adobe;
    jpeg_set_quality(&jpeg, 100, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<std::uint8_t> row;
    for (int i = 0; i < 8; ++i)
        for (const std::uint8_t ink : {c, m, y, k}) row.push_back(adobe ? std::uint8_t(255 - ink) : ink);
    JSAMPROW pointer = row.data();
    while (jpeg.next_scanline < jpeg.image_height) jpeg_write_scanlines(&jpeg, &pointer, 1);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const std::string bytes(reinterpret_cast<char*>(memory), size);
    std::free(memory);
    return bytes;
}

std::string ktx(const Ktx& ktx, const std::string& level) {
    std::string packed = level;
    if (ktx.packing == 2) {
        packed.resize(ZSTD_compressBound(level.size()));
        packed.resize(ZSTD_compress(packed.data(), packed.size(), level.data(), level.size(), 1));
    } else if (ktx.packing == 3) {
        uLongf size = compressBound(level.size());
        packed.resize(size);
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(level.data()),
                 level.size());
        packed.resize(size);
    }
    const std::size_t keys = 104, behind = keys + ktx.keys.size();
    return "\xABKTX 20\xBB\r\n\x1A\n" + low_first(ktx.format, 4) + low_first(1, 4) + low_first(ktx.width, 4) +
           low_first(ktx.height, 4) + low_first(0, 8) + low_first(1, 4) + low_first(1, 4) + low_first(ktx.packing, 4) +
           low_first(0, 8) + low_first(keys, 4) + low_first(ktx.keys.size(), 4) + low_first(0, 16) +
           low_first(behind, 8) + low_first(packed.size(), 8) + low_first(level.size(), 8) + ktx.keys + packed;
}

namespace {

/// Channels of floats, and their slices, for a header and what is written by it.
struct ExrPlanes {
    Imf::Header header;
    Imf::FrameBuffer buffer;
    std::vector<std::vector<float>> values;
    int rows;

    explicit ExrPlanes(const ExrPicture& picture)
        : header(Imath::Box2i({picture.display[0], picture.display[1]}, {picture.display[2], picture.display[3]}),
                 Imath::Box2i({picture.data[0], picture.data[1]}, {picture.data[2], picture.data[3]})),
          values(picture.channels.size()),
          rows(picture.data[3] - picture.data[1] + 1) {
        for (std::size_t c = 0; c < picture.channels.size(); ++c) {
            for (int y = picture.data[1]; y <= picture.data[3]; ++y)
                for (int x = picture.data[0]; x <= picture.data[2]; ++x)
                    values[c].push_back(float(100 * y + x) + float(c) / 8);
            header.channels().insert(picture.channels[c], Imf::Channel(Imf::FLOAT));
            buffer.insert(picture.channels[c], Imf::Slice::Make(Imf::FLOAT, values[c].data(), header.dataWindow()));
        }
        if (const auto& n = picture.chromaticities; n.size() == 8)
            Imf::addChromaticities(header, {{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}});
        if (picture.envmap) Imf::addEnvmap(header, Imf::Envmap(*picture.envmap));
    }
};

}  // namespace

std::string windowed_exr(const ExrPicture& picture) {
    ExrBytes memory;
    {
        const ExrPlanes planes(picture);
        Imf::OutputFile file(memory, planes.header);
        file.setFrameBuffer(planes.buffer);
        file.writePixels(planes.rows);
    }
    return memory.bytes();
}

std::string chroma_exr(float red, float green, float blue) {
    ExrBytes memory;
    {
        constexpr int width = 16, height = 12;
        const std::vector<Imf::Rgba> pixels(width * height, Imf::Rgba(red, green, blue));
        Imf::RgbaOutputFile file(memory, Imf::Header(width, height), Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, width);
        file.writePixels(height);
    }
    return memory.bytes();
}

std::string cube_exr(int size, bool tiled) {
    Imf::Header header(size, 6 * size);
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    std::vector<Imath::V3f> pixels(std::size_t(6 * size * size));
    for (int i = 0; i < 6 * size * size; ++i) {
        const auto face = Imf::CubeMapFace(i / (size * size));
        const Imath::V2f in_face(float(i % size), float(i / size % size));
        const Imath::V2f place = Imf::CubeMap::pixelPosition(face, header.dataWindow(), in_face);
        pixels[std::size_t(place.y) * std::size_t(size) + std::size_t(place.x)] =
            Imath::V3f(2) + Imf::CubeMap::direction(face, header.dataWindow(), in_face).normalized();
    }
    Imf::FrameBuffer buffer;
    const auto slice = [&](float& first) {
        return Imf::Slice::Make(Imf::FLOAT, &first, header.dataWindow(), sizeof(Imath::V3f),
                                sizeof(Imath::V3f) * std::size_t(size));
    };
    buffer.insert("R", slice(pixels[0].x)), buffer.insert("G", slice(pixels[0].y));
    buffer.insert("B", slice(pixels[0].z));
    ExrBytes memory;
    if (tiled) {
        header.setTileDescription({16, 16, Imf::MIPMAP_LEVELS});
        Imf::TiledOutputFile file(memory, header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
        for (int level = 1; level < file.numLevels(); ++level)  // of other numbers: nothing reads them
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    } else {
        Imf::OutputFile file(memory, header);
        file.setFrameBuffer(buffer);
        file.writePixels(6 * size);
    }
    return memory.bytes();
}

std::string parts_exr() {
    ExrBytes memory;
    {
        ExrPlanes depth({.channels = {"Z"}}), colours({.channels = {"R", "G", "B"}});
        std::vector<Imf::Header> headers{depth.header, colours.header};
        for (std::size_t i = 0; i < 2; ++i)
            headers[i].setName(i ? "colours" : "depth"), headers[i].setType(Imf::SCANLINEIMAGE);
        Imf::MultiPartOutputFile file(memory, headers.data(), 2);
        for (int i = 0; i < 2; ++i) {
            Imf::OutputPart part(file, i);
            part.setFrameBuffer((i ? colours : depth).buffer);
            part.writePixels(2);
        }
    }
    return memory.bytes();
}

}  // namespace lightnet::test
