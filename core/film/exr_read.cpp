// OpenEXR files become pictures.
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/exr_claims.hpp"
#include "core/base/plain_file.hpp"
#include "core/film/exr.hpp"
#include "core/film/exr_channels.hpp"

namespace lightnet {
namespace {

using namespace exr;

constexpr std::uint32_t most_ranks = 200;  // two digits count pairs of them

constexpr std::uint64_t largest_exr = std::uint64_t{16} << 30;

std::int64_t length(int min, int max) { return std::int64_t{max} - min + 1; }

std::size_t pixels_of(const Imath::Box2i& window) {
    return static_cast<std::size_t>(length(window.min.x, window.max.x) * length(window.min.y, window.max.y));
}

// Room is taken for what a file claims to have, so it must be able to have it.
void expect_plausible(const std::filesystem::path& path) {
    PlainFile file(path, largest_exr);
    try {
        check_exr_claims([&](std::span<std::byte> into) { return file.read(into); }, file.size());
    } catch (const Error& wrong) {
        throw Error(path.string(), std::string("is damaged: ") + wrong.what());
    }
}

void expect_pixels(const Imath::Box2i& window, const std::filesystem::path& path) {
    const auto width = length(window.min.x, window.max.x), height = length(window.min.y, window.max.y);
    if (width > std::numeric_limits<int>::max() || height > std::numeric_limits<int>::max())
        throw Error(path.string(), fmt::format("is damaged: there are no {} x {} pixels", width, height));
}

/// Reads channels of an open file to where they are wanted, all at once.
class Wanted {
public:
    explicit Wanted(Imf::InputFile& file) : file_(file), window_(file.header().dataWindow()) {}
    // The library writes there, whatever type it is told.
    void add(const std::string& name, const float* to, std::size_t step) {
        if (!file_.header().channels().findChannel(name)) throw Error(file_.fileName(), "has no channel " + name);
        buffer_.insert(name, Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(to), window_, step,
                                              step * static_cast<std::size_t>(window_.max.x - window_.min.x + 1)));
    }
    void read() {
        file_.setFrameBuffer(buffer_);
        file_.readPixels(window_.min.y, window_.max.y);
    }
    std::size_t pixels() const { return pixels_of(window_); }

private:
    Imf::InputFile& file_;
    Imath::Box2i window_;
    Imf::FrameBuffer buffer_;
};

bool has_all(const Imf::ChannelList& channels, const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [&](const auto& name) { return channels.findChannel(name); });
}

// What the channels of a layer end in; the usual letters, where it has none of ours.
std::string letters_of(const Imf::ChannelList& channels, const std::string& layer) {
    for (const char* letters : {usual_letters, letters_of_vectors, letters_of_depths, letters_of_uv})
        if (has_all(channels, channels_of(layer, letters))) return letters;
    return usual_letters;
}

// The pixels of a layer, which come with read(); fails if the file lacks a channel of it.
std::vector<Rgb> wanted_layer(Wanted& wanted, const std::string& layer, const std::string& letters) {
    std::vector<Rgb> pixels(wanted.pixels());
    for_channels(channels_of(layer, letters), pixels,
                 [&](const std::string& name, const float* first) { wanted.add(name, first, sizeof(Rgb)); });
    return pixels;
}

// A depth is grey.
void make_depths_grey(std::vector<PictureLayer>& layers) {
    for (auto& layer : layers)
        if (layer.letters == letters_of_depths)
            for (Rgb& pixel : layer.pixels) pixel = {pixel.r, pixel.r, pixel.r};
}

// Empty: the file has no such channel.
std::vector<float> read_channel(Imf::InputFile& file, const char* name) {
    if (!file.header().channels().findChannel(name)) return {};
    Wanted wanted(file);
    std::vector<float> values(wanted.pixels());
    wanted.add(name, values.data(), sizeof(float));
    wanted.read();
    return values;
}

const std::string* text_in(const Imf::Header& header, const std::string& name) {
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>(name.c_str());
    return text ? &text->value() : nullptr;
}

std::uint32_t ranks_of(const std::string& matte, const Imf::ChannelList& channels) {
    std::uint32_t ranks = 0;
    for (; ranks < most_ranks; ranks += 2) {
        const auto names = matte_channels(matte, ranks / 2);
        if (!has_all(channels, {names.begin(), names.end()})) break;
    }
    return ranks;
}

std::vector<PictureMatte> read_mattes(Imf::InputFile& file) {
    const auto& header = file.header();
    std::vector<PictureMatte> mattes;
    for (auto one = header.begin(); one != header.end(); ++one) {
        const std::string attribute = one.name();
        const auto* name = text_in(header, attribute);
        if (!name || !attribute.starts_with(of_mattes) || attribute != matte_key(*name) + "/name") continue;
        PictureMatte& matte = mattes.emplace_back(PictureMatte{*name, ranks_of(*name, header.channels()), {}, {}});
        if (const auto* manifest = text_in(header, matte_key(*name) + "/manifest")) matte.manifest = *manifest;
        Wanted wanted(file);
        matte.pixels.resize(wanted.pixels() * matte.ranks);
        for_matte_channels(matte, [&](const std::string& channel, const float* first, std::size_t step) {
            wanted.add(channel, first, step);
        });
        wanted.read();
    }
    return mattes;
}

PictureNotes notes_in(const Imf::Header& header) {
    PictureNotes notes;
    for (auto one = header.begin(); one != header.end(); ++one) {
        const std::string name = one.name();
        const bool own = name.starts_with(of_mattes) || name == colours_attribute;
        if (const auto* text = text_in(header, name); text && !own) notes.texts[name] = *text;
        if (const auto* matrix = header.findTypedAttribute<Imf::M44fAttribute>(name.c_str()))
            for (std::size_t i = 0; i < 16; ++i) notes.matrices[name][i] = matrix->value()[int(i / 4)][int(i % 4)];
    }
    return notes;
}

// A file that is packed in another way is written as usual.
PictureStorage storage_of(const Imf::Header& header, const std::vector<PictureLayer>& shown) {
    PictureStorage storage;
    const auto& compressions = lossless_compressions();
    if (const auto number = static_cast<std::size_t>(header.compression()); number < compressions.size())
        storage.compression = compressions[number];
    for (const auto& layer : shown)
        if (const auto* channel = header.channels().findChannel(channels_of(layer.name, layer.letters).front()))
            storage.half = storage.half || channel->type == Imf::HALF;
    return storage;
}

void read_gains(const Imf::Header& header, std::vector<PictureLayer>& layers) {
    const auto* gains = header.findTypedAttribute<Imf::FloatVectorAttribute>(gains_attribute);
    if (!gains || gains->value().size() != 3 * layers.size()) return;
    const float* next = gains->value().data();
    for (auto& layer : layers) layer.gain = {next[0], next[1], next[2]}, next += 3;
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

Picture read_exr(const std::filesystem::path& path) try {
    expect_plausible(path);
    Imf::InputFile file(path.c_str(), 0);
    const auto window = file.header().dataWindow();
    expect_pixels(window, path);
    Picture picture{static_cast<std::uint32_t>(window.max.x - window.min.x + 1),
                    static_cast<std::uint32_t>(window.max.y - window.min.y + 1),
                    {},
                    {}};
    Wanted wanted(file);  // all at once: each reading of a file unpacks all of it
    picture.beauty = wanted_layer(wanted, "", usual_letters);
    for (auto [attribute, layers] : {std::pair(layers_attribute, &picture.layers), {shown_attribute, &picture.shown}})
        if (const auto* names = file.header().findTypedAttribute<Imf::StringVectorAttribute>(attribute))
            for (const auto& name : names->value()) {
                if (std::any_of(layers->begin(), layers->end(), [&](const auto& known) { return known.name == name; }))
                    throw Error(path.string(), "is damaged: it names layer " + name + " twice");
                const auto letters = letters_of(file.header().channels(), name);
                layers->push_back({name, wanted_layer(wanted, name, letters), {1, 1, 1}, letters});
            }
    wanted.read();
    make_depths_grey(picture.layers);
    make_depths_grey(picture.shown);
    read_gains(file.header(), picture.layers);
    picture.samples = read_channel(file, samples_channel);
    picture.alpha = read_channel(file, alpha_channel);
    picture.mattes = read_mattes(file);
    picture.notes = notes_in(file.header());
    picture.storage = storage_of(file.header(), picture.shown);
    read_place(file.header(), picture);
    if (const auto* done = file.header().findTypedAttribute<Imf::FloatAttribute>(done_attribute))
        picture.done = done->value();
    return picture;
} catch (const Error&) {
    throw;
} catch (const std::bad_alloc&) {
    throw Error(path.string(), "there is not enough memory for its pixels");
} catch (const std::exception& wrong) {
    throw Error(path.string(), wrong.what());
}

}  // namespace lightnet
