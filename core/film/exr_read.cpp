// OpenEXR files become pictures.
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/exr_claims.hpp"
#include "core/base/own_files.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/words_of.hpp"
#include "core/film/exr.hpp"
#include "core/film/exr_channels.hpp"

namespace lightnet {
namespace {

using namespace exr;

constexpr std::uint32_t most_ranks = 200;  // two digits count pairs of them

constexpr std::uint64_t largest_exr = std::uint64_t{16} << 30;

std::int64_t length(int min, int max) { return std::int64_t{max} - min + 1; }

// Room is taken for what a file claims to have, so it must be able to have it.
void expect_plausible(const std::filesystem::path& path) {
    PlainFile file(path, largest_exr);
    std::string first(exr_beginning.size(), '\0');
    file.read(std::as_writable_bytes(std::span(first)));
    if (first != exr_beginning) throw Error(path.string(), "is no EXR picture");
    file.seek(0);
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

/// An open file of one part or several, whose channels are those of all parts that have the window of the first. Of
/// channels with one name that of the first part counts. Throws what OpenEXR does.
class Parts {
public:
    explicit Parts(const std::filesystem::path& path);

    /// Of the first part: what is said of the picture.
    const Imf::Header& header() const { return file_.header(0); }
    bool several() const { return file_.parts() > 1; }
    /// Null: there is none of that name.
    const Imf::Channel* channel(const std::string& name) const;
    bool has_all(const std::vector<std::string>& names) const;
    std::size_t pixels() const;

    /// The channel is to come to there with read(), a number every `step` bytes. Throws Error where it isn't there.
    void want(const std::string& name, const float* to, std::size_t step);
    /// Reads all that is wanted: each part is unpacked once.
    void read();

private:
    std::optional<int> part_of(const std::string& channel) const;

    std::filesystem::path path_;
    Imf::MultiPartInputFile file_;
    std::vector<Imf::FrameBuffer> wanted_;  // by part
};

Parts::Parts(const std::filesystem::path& path)
    : path_(path), file_(path.c_str(), 0), wanted_(static_cast<std::size_t>(file_.parts())) {}

std::optional<int> Parts::part_of(const std::string& channel) const {
    for (int part = 0; part < file_.parts(); ++part)
        if (file_.header(part).dataWindow() == header().dataWindow() &&
            file_.header(part).channels().findChannel(channel))
            return part;
    return std::nullopt;
}

const Imf::Channel* Parts::channel(const std::string& name) const {
    const auto part = part_of(name);
    return part ? file_.header(*part).channels().findChannel(name) : nullptr;
}

bool Parts::has_all(const std::vector<std::string>& names) const {
    return std::all_of(names.begin(), names.end(), [&](const auto& name) { return part_of(name).has_value(); });
}

std::size_t Parts::pixels() const {
    const auto& window = header().dataWindow();
    return static_cast<std::size_t>(length(window.min.x, window.max.x) * length(window.min.y, window.max.y));
}

void Parts::want(const std::string& name, const float* to, std::size_t step) {
    const auto part = part_of(name);
    if (!part) throw Error(path_.string(), "has no channel " + name);
    const auto& window = header().dataWindow();
    // The library writes there, whatever type it is told.
    wanted_[static_cast<std::size_t>(*part)].insert(
        name, Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(to), window, step,
                               step * static_cast<std::size_t>(window.max.x - window.min.x + 1)));
}

void Parts::read() {
    const auto& window = header().dataWindow();
    for (int part = 0; part < file_.parts(); ++part) {
        auto& wanted = wanted_[static_cast<std::size_t>(part)];
        if (wanted.begin() == wanted.end()) continue;
        Imf::InputPart from(file_, part);
        from.setFrameBuffer(wanted);
        from.readPixels(window.min.y, window.max.y);
        wanted = {};
    }
}

// What the channels of a layer end in; the usual letters, where it has none of ours.
std::string letters_of(const Parts& file, const std::string& layer) {
    for (const char* letters : {usual_letters, letters_of_vectors, letters_of_depths, letters_of_uv, letters_of_motion})
        if (file.has_all(channels_of(layer, letters))) return letters;
    return usual_letters;
}

// The pixels of a layer, which come with read(); fails if the file lacks a channel of it.
std::vector<Rgb> wanted_layer(Parts& file, const std::string& layer, const std::string& letters) {
    std::vector<Rgb> pixels(file.pixels());
    for_channels(channels_of(layer, letters), pixels,
                 [&](const std::string& name, const float* first) { file.want(name, first, sizeof(Rgb)); });
    return pixels;
}

// A depth is grey.
void make_depths_grey(std::vector<PictureLayer>& layers) {
    for (auto& layer : layers)
        if (layer.letters == letters_of_depths)
            for (Rgb& pixel : layer.pixels) pixel = {pixel.r, pixel.r, pixel.r};
}

// Empty: the file has no such channel.
std::vector<float> read_channel(Parts& file, const char* name) {
    if (!file.channel(name)) return {};
    std::vector<float> values(file.pixels());
    file.want(name, values.data(), sizeof(float));
    file.read();
    return values;
}

const std::string* text_in(const Imf::Header& header, const std::string& name) {
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>(name.c_str());
    return text ? &text->value() : nullptr;
}

std::uint32_t ranks_of(const std::string& matte, const Parts& file) {
    std::uint32_t ranks = 0;
    for (; ranks < most_ranks; ranks += 2) {
        const auto names = matte_channels(matte, ranks / 2);
        if (!file.has_all({names.begin(), names.end()})) break;
    }
    return ranks;
}

std::vector<PictureMatte> read_mattes(Parts& file) {
    const auto& header = file.header();
    std::vector<PictureMatte> mattes;
    for (auto one = header.begin(); one != header.end(); ++one) {
        const std::string attribute = one.name();
        const auto* name = text_in(header, attribute);
        if (!name || !attribute.starts_with(of_mattes) || attribute != matte_key(*name) + "/name") continue;
        PictureMatte& matte = mattes.emplace_back(PictureMatte{*name, ranks_of(*name, file), {}, {}});
        if (const auto* manifest = text_in(header, matte_key(*name) + "/manifest")) matte.manifest = *manifest;
        matte.pixels.resize(file.pixels() * matte.ranks);
        for_matte_channels(matte, [&](const std::string& channel, const float* first, std::size_t step) {
            file.want(channel, first, step);
        });
        file.read();
    }
    return mattes;
}

PictureNotes notes_in(const Imf::Header& header) {
    PictureNotes notes;
    for (auto one = header.begin(); one != header.end(); ++one) {
        const std::string name = one.name();
        const bool of_part = name == "name" || name == "type";
        const bool own = name.starts_with(of_mattes) || name == colours_attribute || of_part;
        if (const auto* text = text_in(header, name); text && !own) notes.texts[name] = *text;
        if (const auto* matrix = header.findTypedAttribute<Imf::M44fAttribute>(name.c_str()))
            for (std::size_t i = 0; i < 16; ++i) notes.matrices[name][i] = matrix->value()[int(i / 4)][int(i % 4)];
    }
    return notes;
}

// A file that is packed in another way is written as usual.
PictureStorage storage_of(const Parts& file, const std::vector<PictureLayer>& shown) {
    PictureStorage storage;
    storage.parts = file.several();
    const auto& compressions = lossless_compressions();
    if (const auto number = static_cast<std::size_t>(file.header().compression()); number < compressions.size())
        storage.compression = compressions[number];
    for (const auto& layer : shown)
        if (const auto* channel = file.channel(channels_of(layer.name, layer.letters).front()))
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
    Parts file(path);
    const auto window = file.header().dataWindow();
    expect_pixels(window, path);
    Picture picture{static_cast<std::uint32_t>(window.max.x - window.min.x + 1),
                    static_cast<std::uint32_t>(window.max.y - window.min.y + 1),
                    {},
                    {}};
    picture.beauty = wanted_layer(file, "", usual_letters);
    for (auto [attribute, layers] : {std::pair(layers_attribute, &picture.layers), {shown_attribute, &picture.shown}})
        if (const auto* names = file.header().findTypedAttribute<Imf::StringVectorAttribute>(attribute))
            for (const auto& name : names->value()) {
                if (std::any_of(layers->begin(), layers->end(), [&](const auto& known) { return known.name == name; }))
                    throw Error(path.string(), "is damaged: it names layer " + name + " twice");
                const auto letters = letters_of(file, name);
                layers->push_back({name, wanted_layer(file, name, letters), {1, 1, 1}, letters});
            }
    file.read();  // all at once: each reading of a part unpacks all of it
    make_depths_grey(picture.layers);
    make_depths_grey(picture.shown);
    read_gains(file.header(), picture.layers);
    picture.samples = read_channel(file, samples_channel);
    picture.alpha = read_channel(file, alpha_channel);
    picture.mattes = read_mattes(file);
    picture.notes = notes_in(file.header());
    picture.storage = storage_of(file, picture.shown);
    read_place(file.header(), picture);
    if (const auto* done = file.header().findTypedAttribute<Imf::FloatAttribute>(done_attribute))
        picture.done = done->value();
    return picture;
} catch (const Error&) {
    throw;
} catch (const std::bad_alloc&) {
    throw Error(path.string(), "there is not enough memory for its pixels");
} catch (const std::exception& wrong) {
    throw Error(path.string(), words_of(wrong));
}

}  // namespace lightnet
