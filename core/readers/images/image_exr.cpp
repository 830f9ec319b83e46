// OpenEXR.
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/allowance.hpp"
#include "core/base/error.hpp"
#include "core/base/exr_claims.hpp"
#include "core/base/spare_threads.hpp"
#include "core/base/words_of.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

class Memory final : public Imf::IStream {
public:
    explicit Memory(Input bytes) : Imf::IStream("picture"), bytes_(bytes) {}

    bool read(char into[], int count) override {
        if (count < 0 || bytes_.size() - at_ < static_cast<std::size_t>(count))
            throw std::runtime_error("the file ends early");
        std::memcpy(into, bytes_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_.size()) throw std::runtime_error("the file ends early");
        at_ = position;
    }

private:
    Input bytes_;
    std::size_t at_ = 0;
};

// Threads that decode, which all pictures share. Each line is decoded by itself: what comes of it is the same.
int decoding_threads() {
#if defined(__SANITIZE_THREAD__)  // it can't see how OpenEXR's threads wait for each other
    return 0;
#else
    static const int count = [] {
        const unsigned wanted = usable_cores();
        const int threads = try_threads(wanted) < wanted ? 0 : static_cast<int>(wanted);
        Imf::setGlobalThreadCount(threads);
        return threads;
    }();
    return count;
#endif
}

/// A rectangle of pixels; y grows downwards.
struct Window {
    std::int64_t left, top, width, height;
    explicit Window(const Imath::Box2i& box)
        : left(box.min.x),
          top(box.min.y),
          width(std::int64_t{box.max.x} - box.min.x + 1),
          height(std::int64_t{box.max.y} - box.min.y + 1) {}
    friend bool operator==(const Window&, const Window&) = default;
    std::size_t count() const { return static_cast<std::size_t>(width * height); }
};

/// The names of the channels that are the picture; "": there is none.
struct Names {
    std::string red, green, blue, alpha;
    bool chroma = false;  // brightness, and colours of fewer pixels
    bool xyz = false;     // red is CIE's X, green Y, blue Z

    bool grey() const { return !chroma && green.empty() && blue.empty(); }
};

bool sampled_fully(const Imf::Channel& channel) { return channel.xSampling == 1 && channel.ySampling == 1; }

/// The channel of a layer that is called so, or by that whole word; letters may be small. "": there is none.
std::string channel_in(const Imf::ChannelList& channels, const std::string& layer, std::string_view name) {
    if (channels.findChannel(layer + std::string(name))) return layer + std::string(name);
    const std::string_view word = name == "R"   ? "red"
                                  : name == "G" ? "green"
                                  : name == "B" ? "blue"
                                  : name == "A" ? "alpha"
                                                : name;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string_view whole = channel.name();
        if (!whole.starts_with(layer)) continue;
        const auto own = whole.substr(layer.size());
        if (same_but_for_case(own, name) || same_but_for_case(own, word)) return std::string(whole);
    }
    return "";
}

/// Those of one layer, all of whose names begin so. Without any name: it has none that are a picture.
Names names_in(const Imf::ChannelList& channels, const std::string& layer) {
    const auto named = [&](const char* name) { return channel_in(channels, layer, name); };
    Names names{named("R"), named("G"), named("B"), named("A")};
    const int colours = int(!names.red.empty()) + int(!names.green.empty()) + int(!names.blue.empty());
    if (colours >= 2) return names;
    if (colours == 1) return {names.red + names.green + names.blue, "", "", names.alpha};
    const std::string bright = named("Y");
    if (!bright.empty() && !named("X").empty() && !named("Z").empty())
        return {named("X"), bright, named("Z"), names.alpha, false, true};
    const bool chroma =
        bright == layer + "Y" && channels.findChannel(layer + "RY") && channels.findChannel(layer + "BY");
    return {bright, "", "", names.alpha, chroma};
}

/// The colours of the file; else of the first layer that has some; else the only channel that there is.
Names names_in(const Imf::ChannelList& channels) {
    Names found = names_in(channels, "");
    std::string all, only;
    int count = 0;
    for (auto channel = channels.begin(); channel != channels.end() && found.red.empty(); ++channel) {
        const std::string name = channel.name();
        all += (all.empty() ? "" : ", ") + name;
        if (!same_but_for_case(name, "A")) only = name, ++count;
        const auto dot = name.rfind('.');
        if (dot == std::string::npos) continue;
        const auto own = std::string_view(name).substr(dot + 1);
        if (!same_but_for_case(own, "R") && !same_but_for_case(own, "red")) continue;
        found = names_in(channels, name.substr(0, dot + 1));
        if (found.grey()) found = {};
    }
    if (!found.red.empty() || !found.green.empty()) return found;
    if (count == 1) return {only, "", "", channel_in(channels, "", "A")};
    throw Error("EXR: there is no channel R, and no channel Y, among several: " + all.substr(0, 200));
}

bool is_cube(const Imf::Header& header) { return Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE; }

Image finished(const Imf::Header& header, const Names& names, std::vector<Rgb> pixels, std::vector<float> alpha) {
    if (names.xyz) {
        turn_to_ours(cie_xyz, pixels);
    } else if (Imf::hasChromaticities(header) && !names.grey()) {
        const auto& said = Imf::chromaticities(header);
        const auto place = [](const Imath::V2f& at) { return Primaries::Place{double{at.x}, double{at.y}}; };
        turn_to_ours({place(said.red), place(said.green), place(said.blue), place(said.white)}, pixels);
    }
    if (is_cube(header)) {
        const Window faces(header.dataWindow());
        if (faces.height == 6 * faces.width) return from_cube(static_cast<std::size_t>(faces.width), pixels, alpha);
        throw Error(fmt::format("EXR: a cube map has six square faces below each other, not {} x {} pixels",
                                faces.width, faces.height));
    }
    // The display window is the picture: what lies outside of it is cut away, what is missing is black.
    const Window from(header.dataWindow()), to(header.displayWindow());
    if (from != to) {
        std::vector<Rgb> shown(to.count());
        std::vector<float> shown_alpha(alpha.empty() ? 0 : to.count());
        const std::int64_t left = std::max(from.left, to.left);
        const std::int64_t right = std::min(from.left + from.width, to.left + to.width);
        const std::int64_t bottom = std::min(from.top + from.height, to.top + to.height);
        for (std::int64_t y = std::max(from.top, to.top); y < bottom && left < right; ++y) {
            const std::int64_t old = (y - from.top) * from.width + left - from.left;
            const std::int64_t now = (y - to.top) * to.width + left - to.left;
            std::copy_n(pixels.begin() + old, right - left, shown.begin() + now);
            if (!alpha.empty()) std::copy_n(alpha.begin() + old, right - left, shown_alpha.begin() + now);
        }
        pixels = std::move(shown), alpha = std::move(shown_alpha);
    }
    return {static_cast<std::uint32_t>(to.width), static_cast<std::uint32_t>(to.height), pixels, alpha};
}

/// Of an InputFile or an InputPart.
template <class File>
Image read_channels(File& file, const Names& names) {
    const Imf::Header& header = file.header();
    const Window window(header.dataWindow());
    for (const std::string& name : {names.red, names.green, names.blue, names.alpha})
        if (const auto* channel = header.channels().findChannel(name); channel && !sampled_fully(*channel))
            throw Error("EXR: images with fewer samples of channel " + name + " than of pixels are not supported");
    std::vector<Rgb> pixels(window.count());
    std::vector<float> alpha(names.alpha.empty() ? 0 : window.count());
    Imf::FrameBuffer buffer;
    const auto slice = [&](const std::string& name, float* first, std::size_t step) {
        if (name.empty()) return;
        const auto row = step * static_cast<std::size_t>(window.width);
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, first, header.dataWindow(), step, row));
    };
    slice(names.red, &pixels[0].r, sizeof(Rgb));
    slice(names.green, &pixels[0].g, sizeof(Rgb));
    slice(names.blue, &pixels[0].b, sizeof(Rgb));
    slice(names.alpha, alpha.data(), sizeof(float));
    file.setFrameBuffer(buffer);
    file.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
    if (names.grey())
        for (auto& pixel : pixels) pixel = {pixel.r, pixel.r, pixel.r};
    return finished(header, names, std::move(pixels), std::move(alpha));
}

/// Brightness of each pixel, and colours of every other one in both directions, which OpenEXR fills in.
Image read_chroma(Input bytes, const Names& names) {
    Memory memory(bytes);
    const std::string layer = names.red.substr(0, names.red.size() - 1);
    Imf::RgbaInputFile file(memory, layer.empty() ? layer : layer.substr(0, layer.size() - 1), decoding_threads());
    const Window window(file.dataWindow());
    std::vector<Imf::Rgba> halves(window.count());
    file.setFrameBuffer(Imf::ComputeBasePointer(halves.data(), file.dataWindow()), 1,
                        static_cast<std::size_t>(window.width));
    file.readPixels(file.dataWindow().min.y, file.dataWindow().max.y);
    std::vector<Rgb> pixels;
    std::vector<float> alpha;
    pixels.reserve(halves.size());
    for (const Imf::Rgba& half : halves) {
        pixels.push_back({float(half.r), float(half.g), float(half.b)});
        if (!names.alpha.empty()) alpha.push_back(float(half.a));
    }
    return finished(file.header(), names, std::move(pixels), std::move(alpha));
}

void check(const Imf::Header& header, Input bytes) {
    const Window data(header.dataWindow()), shown(header.displayWindow());
    check_size(data.width, data.height);
    // black all around the data takes no bytes
    check_size(shown.width, shown.height, bytes, 40'000);
}

/// The first part that has colours, or one that may pass for a picture.
int part_of(const Imf::MultiPartInputFile& file) {
    int single = -1;
    for (int part = 0; part < file.parts(); ++part) try {
            const Names names = names_in(file.header(part).channels());
            if (!names.grey()) return part;
            if (single < 0 || names.red.ends_with("Y")) single = part;
        } catch (const Error&) {
        }
    return std::max(single, 0);
}

Image decode(Input bytes) {
    check_exr_claims(bytes);
    Memory memory(bytes);
    constexpr std::size_t flags = 5;  // of the file: behind its magic and version
    constexpr auto several_parts = std::byte{0x10};
    if (bytes.size() > flags && (bytes[flags] & several_parts) != std::byte{}) {
        Imf::MultiPartInputFile all(memory, decoding_threads());
        Imf::InputPart part(all, part_of(all));
        check(part.header(), bytes);
        const Names names = names_in(part.header().channels());
        if (names.chroma) throw Error("EXR: parts with fewer samples of colour than of brightness are not supported");
        return read_channels(part, names);
    }
    Imf::InputFile file(memory, decoding_threads());
    check(file.header(), bytes);
    const Names names = names_in(file.header().channels());
    return names.chroma ? read_chroma(bytes, names) : read_channels(file, names);
}

}  // namespace

Image read_exr(Input bytes) {
    try {
        return decode(bytes);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& problem) {
        throw Error(std::string("EXR: ") + words_of(problem));
    }
}

}  // namespace lightnet::decoders
