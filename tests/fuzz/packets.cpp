#include <array>
#include <cstring>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "tests/fuzz/put_right.hpp"
#include "tests/fuzz/targets.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::fuzz {

using View = std::span<const std::byte>;

std::vector<std::byte> put_right(View given, View body) {
    std::vector<std::byte> header(given.begin(), given.end());
    const auto put = [&](std::size_t at, auto value) { std::memcpy(header.data() + at, &value, sizeof value); };
    constexpr std::size_t checksum_at = packet::header_size - sizeof(std::uint64_t);
    put(0, packet::magic);
    put(4, packet::version);
    put(checksum_at - sizeof(std::uint32_t), static_cast<std::uint32_t>(body.size()));
    put(checksum_at, XXH3_64bits_withSeed(body.data(), body.size(), XXH3_64bits(header.data(), checksum_at)));
    return header;
}

namespace {

void read_both(View header, View body) {
    (void)packet::peek_header(header);
    (void)packet::claimed_version(header);
    (void)packet::unpack(header, body);
}

void read(View bytes) {
    (void)packet::unpack_fields(bytes);
    const auto header = bytes.first(std::min(bytes.size(), packet::header_size));
    const auto body = bytes.subspan(header.size());
    read_both(header, body);
    if (header.size() < packet::header_size) return;
    (void)packet::unpack_fields(body);
    (void)packet::unpack_piece(body);
    read_both(put_right(header, body), body);
}

std::string text_of(const packet::Packet& packet) {
    std::string text(packet.header.size() + packet.body.size(), '\0');
    std::memcpy(text.data(), packet.header.data(), packet.header.size());
    std::memcpy(text.data() + packet.header.size(), packet.body.data(), packet.body.size());
    return text;
}

template <class Question>
Message ask(std::vector<Question> questions) {
    Message message;
    message.questions = Questions<Question>(std::make_shared<const std::vector<Question>>(std::move(questions)));
    return message;
}

std::vector<std::string> seeds() {
    Message reply, dark, failure;
    reply.type = Message::Type::reply;
    reply.answers = {{1, 2, 3}, {4, 5, 6}};
    dark.type = Message::Type::reply;
    dark.answers = {{}, {}, {1, 2, 3}, {}, {}, {}, {}, {}, {}, {4, 5, 6}};
    failure.type = Message::Type::failure;
    failure.trouble.why = "no photons";
    std::vector<std::string> seeds;
    for (const auto& message :
         {ask(std::vector<Query>(3)), ask(std::vector<Tile>{{0, 16, 32, 16, 16, 16}}), reply, dark, failure})
        seeds.push_back(text_of(packet::pack(message, 0)));
    const auto fields = packet::Fields{}.set("places", 4).set("build", "0.1.0").set("offset", std::uint64_t{1} << 40);
    seeds.push_back(text_of(packet::pack(packet::Type::hello, 1, fields)));
    const auto piece = packet::Fields{}.set("hash", std::string(64, 'a')).set("offset", 7).set("size", 9);
    for (const auto type : {packet::Type::fetch, packet::Type::lacks, packet::Type::expect})
        seeds.push_back(text_of(packet::pack(type, 1, piece)));
    const std::array bytes{std::byte{1}, std::byte{2}};
    seeds.push_back(text_of(packet::pack(1, packet::Piece{content_hash(bytes), 7, bytes})));
    return seeds;
}

}  // namespace

Target packets() { return {"packets", read, seeds}; }

}  // namespace lightnet::fuzz
