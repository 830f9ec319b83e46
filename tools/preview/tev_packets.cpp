#include "tools/preview/tev_packets.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

namespace lightnet {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers go to tev as they lie in memory");

enum class TevKind : char { open_image = 0, close_image = 2, create_image = 4, update_image = 6 };

class TevPacket {
public:
    explicit TevPacket(TevKind kind) : bytes_(sizeof(std::uint32_t), '\0') { bytes_ += static_cast<char>(kind); }

    template <class Number>
    TevPacket& add(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
        return *this;
    }
    TevPacket& add(const std::string& text) {
        bytes_.append(text.c_str(), text.size() + 1);
        return *this;
    }
    TevPacket& add(const std::vector<std::string>& texts) {
        for (const auto& text : texts) add(text);
        return *this;
    }
    TevPacket& add(std::span<const float> values) {
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        return *this;
    }
    std::string bytes() && {
        const auto size = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &size, sizeof size);
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

constexpr char stays_behind = 0;  // the window that the user is at keeps the keyboard

std::int32_t int32(std::size_t number) { return static_cast<std::int32_t>(number); }

}  // namespace

std::string tev_create_image(const std::string& name, const Window& size, const std::vector<std::string>& channels) {
    TevPacket packet(TevKind::create_image);
    packet.add(stays_behind).add(name).add(int32(size.width)).add(int32(size.height));
    packet.add(int32(channels.size())).add(channels);
    return std::move(packet).bytes();
}

std::string tev_update_image(const std::string& name, const std::vector<std::string>& channels, const Window& where,
                             std::span<const float> values) {
    TevPacket packet(TevKind::update_image);
    packet.add(stays_behind).add(name).add(int32(channels.size())).add(channels);
    for (const auto number : {where.x, where.y, where.width, where.height}) packet.add(int32(number));
    const auto count = static_cast<std::int64_t>(channels.size());
    for (std::int64_t offset = 0; offset < count; ++offset) packet.add(offset);
    for (std::int64_t channel = 0; channel < count; ++channel) packet.add(count);  // from one pixel to the next
    packet.add(values);
    return std::move(packet).bytes();
}

std::string tev_close_image(const std::string& name) {
    return std::move(TevPacket(TevKind::close_image).add(name)).bytes();
}

std::string tev_open_image(const std::string& file) {
    return std::move(TevPacket(TevKind::open_image).add(stays_behind).add(file)).bytes();
}

}  // namespace lightnet
