// Packed files, sound ones and hostile ones.
#include "core/readers/files/gzip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "core/base/error.hpp"

namespace lightnet::gzip_test {
namespace {

using testing::HasSubstr;

std::vector<std::byte> packed(const std::vector<std::byte>& bytes) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::vector<std::byte> result(deflateBound(&stream, bytes.size()));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

std::string error_of(const std::vector<std::byte>& bytes, std::size_t most) {
    try {
        gunzip(bytes, most);
        return "no error";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Gzip, UnpacksWhatWasPacked) {
    std::vector<std::byte> bytes(100000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * i >> 3);
    EXPECT_EQ(gunzip(packed(bytes)), bytes);
    EXPECT_EQ(gunzip(packed(bytes), bytes.size()), bytes) << "exactly as much as is allowed";
}

TEST(Gzip, RefusesBombs) {
    const auto bomb = packed(std::vector<std::byte>(std::size_t{64} << 20));
    ASSERT_LT(bomb.size(), 100'000u);
    EXPECT_THAT(error_of(bomb, std::size_t{4} << 20), HasSubstr("more than 4 MiB when unpacked"));
}

TEST(Gzip, RefusesWhatIsCutOrBroken) {
    auto bytes = packed(std::vector<std::byte>(1000, std::byte{7}));
    const std::vector<std::byte> cut(bytes.begin(), bytes.end() - 9);
    EXPECT_THAT(error_of(cut, 1 << 20), HasSubstr("ends early"));
    bytes[bytes.size() - 5] ^= std::byte{1};  // of the checksum
    EXPECT_THAT(error_of(bytes, 1 << 20), HasSubstr("is broken"));
}

}  // namespace
}  // namespace lightnet::gzip_test
