#include "core/film/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringVectorAttribute.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr const char* layers_attribute = "layers";
constexpr const char* shown_attribute = "shown";
constexpr const char* gains_attribute = "gains";
constexpr const char* done_attribute = "done";
constexpr const char* samples_channel = "samples";

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
Imf::Slice slice(const float* first, const Imath::Box2i& window, std::size_t step = sizeof(Rgb)) {
    return Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(first), window, step,
                            step * static_cast<std::size_t>(window.max.x - window.min.x + 1));
}

// Nothing where all are 1.
void insert_gains(Imf::Header& header, const std::vector<PictureLayer>& layers) {
    Imf::FloatVector gains;
    for (const auto& layer : layers) gains.insert(gains.end(), {layer.gain.r, layer.gain.g, layer.gain.b});
    if (std::any_of(gains.begin(), gains.end(), [](float gain) { return gain != 1; }))
        header.insert(gains_attribute, Imf::FloatVectorAttribute(gains));
}

void read_gains(const Imf::Header& header, std::vector<PictureLayer>& layers) {
    const auto* gains = header.findTypedAttribute<Imf::FloatVectorAttribute>(gains_attribute);
    if (!gains || gains->value().size() != 3 * layers.size()) return;
    const float* next = gains->value().data();
    for (auto& layer : layers) layer.gain = {next[0], next[1], next[2]}, next += 3;
}

Imf::Header header_of(const Picture& picture) {
    const auto box = [](std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
        const auto left = static_cast<int>(x), top = static_cast<int>(y);
        return Imath::Box2i({left, top}, {left + static_cast<int>(width) - 1, top + static_cast<int>(height) - 1});
    };
    const auto data = box(picture.x, picture.y, picture.width, picture.height);
    Imf::Header header(picture.whole_width ? box(0, 0, picture.whole_width, picture.whole_height) : data, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.lineOrder() = Imf::INCREASING_Y;
    const auto insert_names = [&](const char* attribute, const std::vector<PictureLayer>& layers) {
        Imf::StringVector names;
        for (const auto& layer : layers) names.push_back(layer.name);
        if (!names.empty()) header.insert(attribute, Imf::StringVectorAttribute(names));
    };
    insert_names(layers_attribute, picture.layers);
    insert_names(shown_attribute, picture.shown);
    insert_gains(header, picture.layers);
    if (picture.done < 1) header.insert(done_attribute, Imf::FloatAttribute(picture.done));
    return header;
}

std::size_t pixels_of(const Imath::Box2i& window) {
    return static_cast<std::size_t>(window.max.x - window.min.x + 1) *
           static_cast<std::size_t>(window.max.y - window.min.y + 1);
}

// One layer of an open file; none if it lacks a channel of it.
std::vector<Rgb> read_layer(Imf::InputFile& file, const std::string& layer) {
    const auto window = file.header().dataWindow();
    std::vector<Rgb> pixels(pixels_of(window));
    Imf::FrameBuffer buffer;
    for_channels(layer, pixels, [&](const std::string& name, const float* first) {
        if (!file.header().channels().findChannel(name)) throw Error(file.fileName(), "has no channel " + name);
        buffer.insert(name, slice(first, window));
    });
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return pixels;
}

std::vector<float> read_samples(Imf::InputFile& file) {
    if (!file.header().channels().findChannel(samples_channel)) return {};
    const auto window = file.header().dataWindow();
    std::vector<float> samples(pixels_of(window));
    Imf::FrameBuffer buffer;
    buffer.insert(samples_channel, slice(samples.data(), window, sizeof(float)));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return samples;
}

// Where the picture lies in a whole, as far as its file tells; files of other programs may lie outside of it.
void read_place(const Imf::Header& header, Picture& picture) {
    const auto data = header.dataWindow(), whole = header.displayWindow();
    const bool inside = whole.min.x == 0 && whole.min.y == 0 && data.min.x >= 0 && data.min.y >= 0 &&
                        data.max.x <= whole.max.x && data.max.y <= whole.max.y;
    if (!inside || data == whole) return;
    picture.x = static_cast<std::uint32_t>(data.min.x);
    picture.y = static_cast<std::uint32_t>(data.min.y);
    picture.whole_width = static_cast<std::uint32_t>(whole.max.x + 1);
    picture.whole_height = static_cast<std::uint32_t>(whole.max.y + 1);
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
    for (const auto& layer : picture.shown) for_channels(layer.name, layer.pixels, add_channel);
    if (!picture.samples.empty()) {
        header.channels().insert(samples_channel, Imf::Channel(Imf::FLOAT));
        buffer.insert(samples_channel, slice(picture.samples.data(), header.dataWindow(), sizeof(float)));
    }

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
    for (auto [attribute, layers] : {std::pair(layers_attribute, &picture.layers), {shown_attribute, &picture.shown}})
        if (const auto* names = file.header().findTypedAttribute<Imf::StringVectorAttribute>(attribute))
            for (const auto& name : names->value()) layers->push_back({name, read_layer(file, name)});
    read_gains(file.header(), picture.layers);
    picture.samples = read_samples(file);
    read_place(file.header(), picture);
    if (const auto* done = file.header().findTypedAttribute<Imf::FloatAttribute>(done_attribute))
        picture.done = done->value();
    return picture;
} catch (const Error&) {
    throw;
} catch (const std::exception& wrong) {
    throw Error(path.string(), wrong.what());
}

}  // namespace lightnet
