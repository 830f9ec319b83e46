// OpenEXR.
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfThreading.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "core/base/allowance.hpp"
#include "core/base/error.hpp"
#include "core/base/exr_claims.hpp"
#include "core/base/spare_threads.hpp"
#include "core/readers/image_decoders.hpp"

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

Image decode(Input bytes) {
    check_exr_claims(bytes);
    Memory memory(bytes);
    Imf::InputFile file(memory, decoding_threads());
    const auto& window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_size(width, height);

    const auto& channels = file.header().channels();
    for (const char* name : {"R", "G", "B", "Y", "A"})
        if (const auto* c = channels.findChannel(name); c && (c->xSampling != 1 || c->ySampling != 1))
            throw Error("EXR: images with fewer samples of colour than of brightness are not supported");
    const bool grey = !channels.findChannel("R");
    if (grey && !channels.findChannel("Y")) throw Error("EXR: there is no channel R, and no channel Y");
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<Rgb> pixels(count);
    std::vector<float> alpha(channels.findChannel("A") ? count : 0);

    Imf::FrameBuffer buffer;
    const auto slice = [&](const char* name, float* first, std::size_t step) {
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, first, window, step, step * static_cast<std::size_t>(width)));
    };
    slice(grey ? "Y" : "R", &pixels[0].r, sizeof(Rgb));
    if (!grey) slice("G", &pixels[0].g, sizeof(Rgb));
    if (!grey) slice("B", &pixels[0].b, sizeof(Rgb));
    if (!alpha.empty()) slice("A", alpha.data(), sizeof(float));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (grey)
        for (auto& pixel : pixels) pixel = {pixel.r, pixel.r, pixel.r};
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), pixels, alpha};
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
        throw Error(std::string("EXR: ") + problem.what());
    }
}

}  // namespace lightnet::decoders
