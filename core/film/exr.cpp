#include "core/film/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringVectorAttribute.h>

#include <cstring>
#include <exception>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/film/atomic_file.hpp"

namespace lightnet {
namespace {

constexpr const char* layers_attribute = "layers";

/// A file in memory, so that the disk sees one checked write and tests see the bytes.
class Memory final : public Imf::OStream {
public:
    Memory() : OStream("picture") {}
    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
        std::memcpy(bytes_.data() + at_, bytes, size);
        at_ += size;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

// Calls visit(channel name, pointer to its value in the first pixel) for R, G and B of a plane of pixels.
template <class Plane, class Visit>
void for_channels(const std::string& layer, Plane& pixels, const Visit& visit) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    auto* first = pixels.data();
    visit(prefix + "R", &first->r);
    visit(prefix + "G", &first->g);
    visit(prefix + "B", &first->b);
}

// OpenEXR takes one type of slice for reading and writing, hence the cast where it only reads.
Imf::Slice slice(const float* first, const Imath::Box2i& window) {
    return Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(first), window, sizeof(Rgb),
                            sizeof(Rgb) * static_cast<std::size_t>(window.max.x - window.min.x + 1));
}

Imf::Header header_of(const Picture& picture) {
    Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    header.lineOrder() = Imf::INCREASING_Y;
    Imf::StringVector names;
    for (const auto& layer : picture.layers) names.push_back(layer.name);
    if (!names.empty()) header.insert(layers_attribute, Imf::StringVectorAttribute(names));
    return header;
}

// One layer of an open file; none if it lacks a channel of it.
std::vector<Rgb> read_layer(Imf::InputFile& file, const std::string& layer) {
    const auto window = file.header().dataWindow();
    std::vector<Rgb> pixels(static_cast<std::size_t>(window.max.x - window.min.x + 1) *
                            static_cast<std::size_t>(window.max.y - window.min.y + 1));
    Imf::FrameBuffer buffer;
    for_channels(layer, pixels, [&](const std::string& name, const float* first) {
        if (!file.header().channels().findChannel(name)) throw Error(file.fileName(), "has no channel " + name);
        buffer.insert(name, slice(first, window));
    });
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return pixels;
}

}  // namespace

std::string exr_of(const Picture& picture) {
    Imf::Header header = header_of(picture);
    Imf::FrameBuffer buffer;
    const auto add_channel = [&](const std::string& name, const float* first) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, slice(first, header.dataWindow()));
    };
    for_channels("", picture.beauty, add_channel);
    for (const auto& layer : picture.layers) for_channels(layer.name, layer.pixels, add_channel);

    Memory memory;
    {
        Imf::OutputFile file(memory, header, 0);  // 0: no threads of OpenEXR's own
        file.setFrameBuffer(buffer);
        file.writePixels(static_cast<int>(picture.height));
    }
    return memory.take();
}

void write_exr(const std::filesystem::path& path, const Picture& picture) { write_file(path, exr_of(picture)); }

Picture read_exr(const std::filesystem::path& path) try {
    Imf::InputFile file(path.c_str(), 0);
    const auto window = file.header().dataWindow();
    Picture picture{static_cast<std::uint32_t>(window.max.x - window.min.x + 1),
                    static_cast<std::uint32_t>(window.max.y - window.min.y + 1),
                    read_layer(file, ""),
                    {}};
    if (const auto* names = file.header().findTypedAttribute<Imf::StringVectorAttribute>(layers_attribute))
        for (const auto& name : names->value()) picture.layers.push_back({name, read_layer(file, name)});
    return picture;
} catch (const Error&) {
    throw;
} catch (const std::exception& wrong) {
    throw Error(path.string(), wrong.what());
}

}  // namespace lightnet
