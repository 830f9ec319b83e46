// Pictures become OpenEXR files.
#include "core/film/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <half.h>

#include <algorithm>
#include <cstring>
#include <list>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/film/exr_channels.hpp"

namespace lightnet {
namespace {

using namespace exr;

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

/// Bytes of a file in memory, read again.
class Written final : public Imf::IStream {
public:
    explicit Written(std::string_view bytes) : IStream("picture"), bytes_(bytes) {}
    bool read(char into[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (at_ > bytes_.size() || bytes_.size() - at_ < size) throw Error("picture", "it ends early");
        std::memcpy(into, bytes_.data() + at_, size);
        at_ += size;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

// Nothing where all are 1.
void insert_gains(Imf::Header& header, const std::vector<PictureLayer>& layers) {
    Imf::FloatVector gains;
    for (const auto& layer : layers) gains.insert(gains.end(), {layer.gain.r, layer.gain.g, layer.gain.b});
    if (std::any_of(gains.begin(), gains.end(), [](float gain) { return gain != 1; }))
        header.insert(gains_attribute, Imf::FloatVectorAttribute(gains));
}

void insert_compression(Imf::Header& header, const std::string& name) {
    static_assert(Imf::NO_COMPRESSION == 0 && Imf::RLE_COMPRESSION == 1 && Imf::ZIPS_COMPRESSION == 2 &&
                  Imf::ZIP_COMPRESSION == 3 && Imf::PIZ_COMPRESSION == 4);
    const auto& names = lossless_compressions();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw Error("film", "no compression is called " + name);
    header.compression() = static_cast<Imf::Compression>(found - names.begin());
}

void insert_text(Imf::Header& header, const std::string& name, const std::string& text) {
    header.insert(name.c_str(), Imf::StringAttribute(text));
}

void insert_notes(Imf::Header& header, const PictureNotes& notes) {
    for (const auto& [name, text] : notes.texts) insert_text(header, name, text);
    for (const auto& [name, entries] : notes.matrices) {
        Imath::M44f matrix;
        for (std::size_t i = 0; i < entries.size(); ++i) matrix[int(i / 4)][int(i % 4)] = entries[i];
        header.insert(name.c_str(), Imf::M44fAttribute(matrix));
    }
}

// What the specification of Cryptomatte (1.2) wants to be said.
void insert_matte(Imf::Header& header, const PictureMatte& matte) {
    const auto key = matte_key(matte.name);
    insert_text(header, key + "/name", matte.name);
    insert_text(header, key + "/hash", "MurmurHash3_32");
    insert_text(header, key + "/conversion", "uint32_to_float32");
    insert_text(header, key + "/manifest", matte.manifest);
}

/// Where the picture lies, how it is packed, and which colours it has: what parts of one file have in common.
Imf::Header bare_header_of(const Picture& picture) {
    const auto box = [](std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
        const auto left = static_cast<int>(x), top = static_cast<int>(y);
        return Imath::Box2i({left, top}, {left + static_cast<int>(width) - 1, top + static_cast<int>(height) - 1});
    };
    const auto data = box(picture.x, picture.y, picture.width, picture.height);
    Imf::Header header(picture.whole_width ? box(0, 0, picture.whole_width, picture.whole_height) : data, data);
    insert_compression(header, picture.storage.compression);
    header.lineOrder() = Imf::INCREASING_Y;
    // The primaries and the white of BT.709 are the library's own.
    Imf::addChromaticities(header, Imf::Chromaticities());
    return header;
}

Imf::Header header_of(const Picture& picture) {
    Imf::Header header = bare_header_of(picture);
    const auto insert_names = [&](const char* attribute, const std::vector<PictureLayer>& layers) {
        Imf::StringVector names;
        for (const auto& layer : layers) names.push_back(layer.name);
        if (!names.empty()) header.insert(attribute, Imf::StringVectorAttribute(names));
    };
    insert_notes(header, picture.notes);
    // The name is the Color Interop Forum's.
    insert_text(header, colours_attribute, "lin_rec709_scene");
    for (const auto& matte : picture.mattes) insert_matte(header, matte);
    insert_names(layers_attribute, picture.layers);
    insert_names(shown_attribute, picture.shown);
    insert_gains(header, picture.layers);
    if (picture.done < 1) header.insert(done_attribute, Imf::FloatAttribute(picture.done));
    return header;
}

/// The channels of a part that is to be written, and where their numbers are.
class Channels {
public:
    explicit Channels(Imf::Header header) : header_(std::move(header)) {}

    void add(const std::string& name, const float* first, std::size_t step) {
        insert(name, Imf::FLOAT, reinterpret_cast<const char*>(first), step);
    }
    void add(const std::vector<std::string>& channels, const std::vector<Rgb>& pixels) {
        for_channels(channels, pixels,
                     [&](const std::string& name, const float* first) { add(name, first, sizeof(Rgb)); });
    }
    void add_halves(const std::vector<std::string>& channels, const std::vector<Rgb>& pixels) {
        auto& halves = halves_.emplace_back();
        halves.reserve(3 * pixels.size());
        for (const Rgb& pixel : pixels)
            for (const float value : {pixel.r, pixel.g, pixel.b}) halves.emplace_back(value);
        const half* next = halves.data();
        for_channels(channels, pixels, [&](const std::string& name, const float*) {
            insert(name, Imf::HALF, reinterpret_cast<const char*>(next++), 3 * sizeof(half));
        });
    }
    void add(const PictureLayer& layer, const PictureStorage& storage) {
        const auto names = channels_of(layer.name, layer.letters);
        may_be_half(storage, layer) ? add_halves(names, layer.pixels) : add(names, layer.pixels);
    }
    void add(const PictureMatte& matte) {
        for_matte_channels(
            matte, [&](const std::string& name, const float* first, std::size_t step) { add(name, first, step); });
    }
    Imf::Header& header() { return header_; }
    const Imf::FrameBuffer& buffer() const { return buffer_; }

private:
    // OpenEXR takes one type of slice for reading and writing, hence the cast where it only reads.
    void insert(const std::string& name, Imf::PixelType type, const char* first, std::size_t step) {
        const auto window = header_.dataWindow();
        header_.channels().insert(name, Imf::Channel(type));
        buffer_.insert(name, Imf::Slice::Make(type, const_cast<char*>(first), window, step,
                                              step * static_cast<std::size_t>(window.max.x - window.min.x + 1)));
    }

    Imf::Header header_;
    Imf::FrameBuffer buffer_;
    std::list<std::vector<half>> halves_;  // until they are written
};

/// What goes into a file, part by part; the first one says all that there is to say.
std::list<Channels> parts_of(const Picture& picture) {
    std::list<Channels> parts;
    std::set<std::string> names;
    const auto next = [&](const std::string& name) -> Channels& {
        if (!parts.empty() && !picture.storage.parts) return parts.front();
        Channels& part = parts.emplace_back(parts.empty() ? header_of(picture) : bare_header_of(picture));
        if (!picture.storage.parts) return part;
        std::string free = name;
        while (!names.insert(free).second) free += "_";
        part.header().setName(free);
        part.header().setType(Imf::SCANLINEIMAGE);
        return part;
    };
    Channels& first = next("rgba");
    first.add(channels_of(""), picture.beauty);
    if (!picture.alpha.empty()) first.add(alpha_channel, picture.alpha.data(), sizeof(float));
    if (!picture.samples.empty()) first.add(samples_channel, picture.samples.data(), sizeof(float));
    for (const auto& layer : picture.layers) next(layer.name).add(layer, {});
    for (const auto& layer : picture.shown) next(layer.name).add(layer, picture.storage);
    std::map<std::string, const PictureMatte*> mattes;  // by name, as files don't tell their order
    for (const auto& matte : picture.mattes) mattes.emplace(matte.name, &matte);
    for (const auto& [name, matte] : mattes) next(name).add(*matte);
    return parts;
}

// The library says nothing where its compressor has no memory, and leaves lines out.
void expect_complete(std::string_view bytes, int parts) {
    Written written(bytes);
    Imf::MultiPartInputFile file(written, 0);
    for (int part = 0; part < parts; ++part)
        if (!file.partComplete(part)) throw Error("picture", "it could not be compressed: there is not enough memory");
}

constexpr int no_threads = 0;  // of OpenEXR's own

void write_parts(Imf::OStream& to, std::list<Channels>& parts, int height) {
    std::vector<Imf::Header> headers;
    for (auto& part : parts) headers.push_back(part.header());
    Imf::MultiPartOutputFile file(to, headers.data(), static_cast<int>(headers.size()), false, no_threads);
    int number = 0;
    for (const auto& part : parts) {
        Imf::OutputPart into(file, number++);
        into.setFrameBuffer(part.buffer());
        into.writePixels(height);
    }
}

}  // namespace

std::string exr_of(const Picture& picture) {
    auto parts = parts_of(picture);
    Memory memory;
    if (picture.storage.parts) {
        write_parts(memory, parts, static_cast<int>(picture.height));
    } else {
        Imf::OutputFile file(memory, parts.front().header(), no_threads);
        file.setFrameBuffer(parts.front().buffer());
        file.writePixels(static_cast<int>(picture.height));
    }
    std::string bytes = memory.take();
    if (picture.storage.compression != lossless_compressions().front())
        expect_complete(bytes, static_cast<int>(parts.size()));
    return bytes;
}

void write_exr(const std::filesystem::path& path, const Picture& picture) { write_file(path, exr_of(picture)); }

}  // namespace lightnet
