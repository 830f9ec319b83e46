// WebP, with libwebp.
#include <webp/decode.h>
#include <webp/demux.h>

#include <memory>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

using WebPDemuxed = std::unique_ptr<WebPDemuxer, decltype(&WebPDemuxDelete)>;

/// The stream of the first frame, and where it lies on a canvas of that size.
struct WebPFrame {
    Input stream;
    std::size_t left = 0, top = 0;
};

WebPFrame first_frame(const WebPDemuxed& demuxed) {
    WebPIterator frame{};
    if (!demuxed || !WebPDemuxGetFrame(demuxed.get(), 1, &frame))
        throw Error("WebP: the file is broken, or ends early");
    const WebPFrame found{std::as_bytes(std::span(frame.fragment.bytes, frame.fragment.size)),
                          static_cast<std::size_t>(frame.x_offset), static_cast<std::size_t>(frame.y_offset)};
    WebPDemuxReleaseIterator(&frame);  // the bytes are ours
    return found;
}

}  // namespace

Raster read_webp(Input bytes) {
    const auto data = [](Input of) { return reinterpret_cast<const std::uint8_t*>(of.data()); };
    const WebPData all{data(bytes), bytes.size()};
    const WebPDemuxed demuxed(WebPDemux(&all), WebPDemuxDelete);
    const auto [stream, left, top] = first_frame(demuxed);
    const std::size_t width = WebPDemuxGetI(demuxed.get(), WEBP_FF_CANVAS_WIDTH);
    const std::size_t height = WebPDemuxGetI(demuxed.get(), WEBP_FF_CANVAS_HEIGHT);
    WebPBitstreamFeatures features{};
    if (WebPGetFeatures(data(stream), stream.size(), &features) != VP8_STATUS_OK)
        throw Error("WebP: the file is broken, or ends early");
    const auto wide = static_cast<std::size_t>(features.width), high = static_cast<std::size_t>(features.height);
    check_size(std::int64_t(width), std::int64_t(height));
    // a picture of one colour takes next to nothing, whatever its size
    constexpr std::size_t believed = std::size_t{1} << 24;
    if (width * height > believed) check_size(std::int64_t(width), std::int64_t(height), bytes, 65'536);
    if (wide + left > width || high + top > height) throw Error("WebP: a frame is larger than the picture");
    const bool whole = wide == width && high == height;
    const bool alpha = features.has_alpha || !whole;
    const std::size_t channels = alpha ? 4 : 3;
    Raster raster{std::uint32_t(width), std::uint32_t(height), int(channels), false, {}};
    raster.bytes.resize(width * height * channels);
    std::uint8_t* const first = raster.bytes.data() + (top * width + left) * channels;
    const std::size_t room = raster.bytes.size() - (top * width + left) * channels;
    const auto decode = alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
    if (!decode(data(stream), stream.size(), first, room, int(width * channels)))
        throw Error("WebP: the file is broken, or ends early");
    return raster;
}

}  // namespace lightnet::decoders
