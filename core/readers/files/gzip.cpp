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

}  // namespace

bool is_gzip(std::span<const std::byte> bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

std::vector<std::byte> gunzip(std::span<const std::byte> bytes, std::size_t most_unpacked) {
    z_stream stream{};
    constexpr int gzip_only = 16;
    if (inflateInit2(&stream, MAX_WBITS + gzip_only) != Z_OK) throw Error("no memory to unpack it");
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
        if (state != Z_OK && state != Z_BUF_ERROR) throw Error("its gzip packing is broken");
        if (written == result.size() && written >= most_unpacked)
            throw Error("more than " + std::to_string(most_unpacked >> 20) + " MiB when unpacked");
        if (written == result.size())
            result.resize(std::min(result.size() * 2, most_unpacked));
        else if (read == bytes.size())
            throw Error("its gzip packing ends early");
    }
    result.resize(written);
    return result;
}

}  // namespace lightnet
