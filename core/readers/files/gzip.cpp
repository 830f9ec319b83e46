#include "core/readers/files/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

struct End {
    void operator()(z_stream* stream) const { inflateEnd(stream); }
};

/// A packing that zlib reads.
struct Packing {
    std::string name;
    int header;  // as inflateInit2() wants it
};

std::vector<std::byte> inflated(std::span<const std::byte> bytes, std::size_t most_unpacked, const Packing& packing) {
    z_stream stream{};
    if (inflateInit2(&stream, MAX_WBITS + packing.header) != Z_OK) throw Error("no memory to unpack it");
    const std::unique_ptr<z_stream, End> end(&stream);
    std::vector<std::byte> result(std::min(std::max<std::size_t>(bytes.size() * 3, 4096), most_unpacked));
    std::size_t read = 0, written = 0;
    for (;;) {
        const auto most = std::size_t{std::numeric_limits<uInt>::max()};
        const auto in = std::min(bytes.size() - read, most), out = std::min(result.size() - written, most);
        // zlib does not write there
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data() + read));
        stream.next_out = reinterpret_cast<Bytef*>(result.data() + written);
        stream.avail_in = static_cast<uInt>(in), stream.avail_out = static_cast<uInt>(out);
        const int state = inflate(&stream, Z_NO_FLUSH);
        read += in - stream.avail_in, written += out - stream.avail_out;
        if (state == Z_STREAM_END) break;
        if (state != Z_OK && state != Z_BUF_ERROR) throw Error("its " + packing.name + " packing is broken");
        if (written == result.size() && written >= most_unpacked)
            throw Error("more than " + std::to_string(most_unpacked >> 20) + " MiB when unpacked");
        if (written == result.size())
            result.resize(std::min(result.size() * 2, most_unpacked));
        else if (read == bytes.size())
            throw Error("its " + packing.name + " packing ends early");
    }
    result.resize(written);
    return result;
}

}  // namespace

bool is_gzip(std::span<const std::byte> bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

std::vector<std::byte> gunzip(std::span<const std::byte> bytes, std::size_t most) {
    return inflated(bytes, most, {"gzip", 16});
}

std::vector<std::byte> unzip(std::span<const std::byte> bytes, std::size_t most) {
    return inflated(bytes, most, {"zlib", 0});
}

}  // namespace lightnet
