// Pictures become OpenEXR files.
#include "core/film/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <half.h>

#include <algorithm>
#include <cstring>
#include <list>
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

Imf::Header header_of(const Picture& picture) {
    const auto box = [](std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
        const auto left = static_cast<int>(x), top = static_cast<int>(y);
        return Imath::Box2i({left, top}, {left + static_cast<int>(width) - 1, top + static_cast<int>(height) - 1});
    };
    const auto data = box(picture.x, picture.y, picture.width, picture.height);
    Imf::Header header(picture.whole_width ? box(0, 0, picture.whole_width, picture.whole_height) : data, data);
    insert_compression(header, picture.storage.compression);
    header.lineOrder() = Imf::INCREASING_Y;
    const auto insert_names = [&](const char* attribute, const std::vector<PictureLayer>& layers) {
        Imf::StringVector names;
        for (const auto& layer : layers) names.push_back(layer.name);
        if (!names.empty()) header.insert(attribute, Imf::StringVectorAttribute(names));
    };
    insert_notes(header, picture.notes);
    // The primaries and the white of BT.709 are the library's own; the name is the Color Interop Forum's.
    Imf::addChromaticities(header, Imf::Chromaticities());
    insert_text(header, colours_attribute, "lin_rec709_scene");
    for (const auto& matte : picture.mattes) insert_matte(header, matte);
    insert_names(layers_attribute, picture.layers);
    insert_names(shown_attribute, picture.shown);
    insert_gains(header, picture.layers);
    if (picture.done < 1) header.insert(done_attribute, Imf::FloatAttribute(picture.done));
    return header;
}

/// The channels of a file that is to be written, and where their numbers are.
class Channels {
public:
    explicit Channels(Imf::Header& header) : header_(header) {}

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
    const Imf::FrameBuffer& buffer() const { return buffer_; }

private:
    // OpenEXR takes one type of slice for reading and writing, hence the cast where it only reads.
    void insert(const std::string& name, Imf::PixelType type, const char* first, std::size_t step) {
        const auto window = header_.dataWindow();
        header_.channels().insert(name, Imf::Channel(type));
        buffer_.insert(name, Imf::Slice::Make(type, const_cast<char*>(first), window, step,
                                              step * static_cast<std::size_t>(window.max.x - window.min.x + 1)));
    }

    Imf::Header& header_;
    Imf::FrameBuffer buffer_;
    std::list<std::vector<half>> halves_;  // until they are written
};

}  // namespace

std::string exr_of(const Picture& picture) {
    Imf::Header header = header_of(picture);
    Channels channels(header);
    channels.add(channels_of(""), picture.beauty);
    for (const auto& layer : picture.layers) channels.add(channels_of(layer.name, layer.letters), layer.pixels);
    for (const auto& layer : picture.shown) {
        const auto names = channels_of(layer.name, layer.letters);
        may_be_half(picture.storage, layer) ? channels.add_halves(names, layer.pixels)
                                            : channels.add(names, layer.pixels);
    }
    for (const auto& matte : picture.mattes)
        for_matte_channels(matte, [&](const std::string& name, const float* first, std::size_t step) {
            channels.add(name, first, step);
        });
    if (!picture.alpha.empty()) channels.add(alpha_channel, picture.alpha.data(), sizeof(float));
    if (!picture.samples.empty()) channels.add(samples_channel, picture.samples.data(), sizeof(float));

    Memory memory;
    {
        Imf::OutputFile file(memory, header, 0);  // 0: no threads of OpenEXR's own
        file.setFrameBuffer(channels.buffer());
        file.writePixels(static_cast<int>(picture.height));
    }
    // The library says nothing where its compressor has no memory, and leaves lines out.
    std::string bytes = memory.take();
    Written written(bytes);
    if (!Imf::InputFile(written, 0).isComplete())
        throw Error("picture", "it could not be compressed: there is not enough memory");
    return bytes;
}

void write_exr(const std::filesystem::path& path, const Picture& picture) { write_file(path, exr_of(picture)); }

}  // namespace lightnet
