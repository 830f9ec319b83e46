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

}  // namespace

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
