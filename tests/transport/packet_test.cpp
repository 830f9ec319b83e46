#include "transport/wire/packet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "transport/wire/body.hpp"
#include "transport/wire/colours.hpp"

namespace lightnet::packet_test {
namespace {

using packet::Fields;
using packet::Packet;
using packet::Type;

Message light_ask(std::size_t count) {
    auto queries = std::make_shared<std::vector<Query>>(count);
    std::uint32_t n = 1;
    for (auto& q : *queries) {
        q = {0x0123456789abcdefull + n,
             n,
             2 * n,
             3 * n,
             0.25f,
             0.5f,
             {1.0f, -2.0f, static_cast<float>(n)},
             5 * n,
             lobe::rough,
             3};
        ++n;
    }
    Message message;
    message.run = 77, message.channel = 3, message.bundle = 12, message.node = 4, message.width = 2;
    message.edition = 6;
    message.questions = Questions<Query>(queries);
    return message;
}

Message tile_ask() {
    Message message;
    message.questions = Questions<Tile>(
        std::make_shared<const std::vector<Tile>>(std::vector<Tile>{{0, 16, 32, 16, 16, 16}, {32, 16, 8, 16, 32, 5}}));
    return message;
}

Message step_ask() {
    Message message;
    message.questions = Questions<Step>(std::make_shared<const std::vector<Step>>(
        std::vector<Step>{{.kind = Step::Kind::go_on,
                           .call = 3,
                           .first = 2,
                           .count = 5,
                           .data = content_hash(std::string_view("photons"))}}));
    return message;
}

Message data_reply() {
    Message message;
    message.type = Message::Type::reply;
    message.data = std::make_shared<const std::vector<std::byte>>(5, std::byte{7});
    return message;
}

Message reply() {
    Message message;
    message.type = Message::Type::reply;
    message.run = 77;
    message.answers = {{1, 2, 3}, {4, 5, 6}};
    message.load = {9, 1234};
    return message;
}

// Of four layers three are black, but for one colour; the last is a zero with a sign.
Message dark_reply(std::size_t count = 45) {
    Message message;
    message.type = Message::Type::reply;
    message.answers.resize(count);
    for (std::size_t i = 0; i < count; i += 4) message.answers[i] = {1, static_cast<float>(i), 0};
    if (count > 13) message.answers[13] = {0, 0, 1e-40f};
    if (count) message.answers.back() = {0, -0.f, 0};
    return message;
}

Message failure() {
    Message message;
    message.type = Message::Type::failure;
    message.trouble.why = "'bounce' on onyx2: no photons";
    return message;
}

TEST(Packet, BringsQuestionsBackBitForBit) {
    const auto sent = light_ask(300);
    const auto packed = packet::pack(sent, 5);
    const auto got = packet::unpack(packed.header, packed.body);
    ASSERT_TRUE(got);
    EXPECT_EQ(*std::get<Questions<Query>>(got->questions), *std::get<Questions<Query>>(sent.questions));
    EXPECT_EQ(got->run, 77u);
    EXPECT_EQ(got->channel, 3u);
    EXPECT_EQ(got->bundle, 12u);
    EXPECT_EQ(got->node, 4u);
    EXPECT_EQ(got->width, 2u);
    EXPECT_EQ(got->edition, 6u);
    EXPECT_EQ(packet::peek_header(packed.header)->place, 5u);
}

TEST(Packet, TakesAtMost48BytesPerQuestionAndAFewPerBundle) {
    const auto packed = packet::pack(light_ask(256), 0);
    EXPECT_LE(packed.body.size() + packed.header.size(), 256 * 48 + 256);
}

TEST(Packet, WritesSmallNumbersInFewBytesAndEqualOnesOnce) {
    for (const auto& [step, most] : {std::pair{0u, 28u}, {1u, 29u}, {200u, 30u}, {100000u, 32u}})
        for (const std::size_t count : {1, 2, 4, 200}) {
            auto queries = std::make_shared<std::vector<Query>>(count);
            for (std::uint32_t i = 0; i < count; ++i) (*queries)[i].primitive = i * step, (*queries)[i].stream = i;
            Message message;
            message.questions = Questions<Query>(queries);
            const auto packed = packet::pack(message, 0);
            EXPECT_LE(packed.body.size(), count * most + 100);
            EXPECT_EQ(*std::get<Questions<Query>>(packet::unpack(packed.header, packed.body)->questions), *queries);
        }
}

TEST(Packet, BringsTilesAnswersAndFailuresBack) {
    const auto tiles = packet::pack(tile_ask(), 0);
    EXPECT_EQ(*std::get<Questions<Tile>>(packet::unpack(tiles.header, tiles.body)->questions),
              *std::get<Questions<Tile>>(tile_ask().questions));
    const auto answers = packet::pack(reply(), 0);
    const auto got = packet::unpack(answers.header, answers.body);
    EXPECT_EQ(got->type, Message::Type::reply);
    EXPECT_EQ(got->answers, reply().answers);
    EXPECT_EQ(got->load, reply().load);
    const auto failed = packet::pack(failure(), 0);
    EXPECT_EQ(packet::unpack(failed.header, failed.body)->trouble, failure().trouble);
}

TEST(Packet, LeavesBlackColoursOut) {
    for (const std::size_t count : {0, 1, 8, 9, 45, 2000}) {
        const auto sent = dark_reply(count);
        const auto packed = packet::pack(sent, 0);
        const auto got = packet::unpack(packed.header, packed.body);
        ASSERT_TRUE(got);
        ASSERT_EQ(got->answers.size(), count);
        EXPECT_TRUE(count == 0 || std::memcmp(got->answers.data(), sent.answers.data(), count * sizeof(Rgb)) == 0);
        EXPECT_LE(packed.body.size(), count * sizeof(Rgb) / 3 + 60);
    }
}

// A body that a sender with bad intentions would make: never more room than for colours that are there, or black.
TEST(Packet, RefusesColoursThatDoNotFitTheirBits) {
    const auto accepted = [](std::uint32_t count, std::vector<std::uint8_t> lit, std::size_t colours) {
        std::vector<std::byte> body;
        packet::BodyWriter writer(body, 2);
        writer.bytes("lit", std::as_bytes(std::span(lit)));
        writer.room("rgb", colours * sizeof(Rgb));
        return packet::unpack_colours(count, body).has_value();
    };
    EXPECT_TRUE(accepted(10, {3, 2}, 3));
    EXPECT_FALSE(accepted(10, {3, 2}, 2));
    EXPECT_FALSE(accepted(10, {3, 2}, 4));
    EXPECT_FALSE(accepted(10, {3}, 2));
    EXPECT_FALSE(accepted(10, {3, 0, 0}, 2));
    EXPECT_FALSE(accepted(10, {3, 4}, 3));  // the eleventh
    EXPECT_FALSE(accepted(0, {1}, 1));
    EXPECT_FALSE(accepted(1 << 30, std::vector<std::uint8_t>(1 << 27), 0));
}

TEST(Packet, BringsStepsAndTheirAnswersBack) {
    const auto step = packet::pack(step_ask(), 0);
    EXPECT_EQ(*std::get<Questions<Step>>(packet::unpack(step.header, step.body)->questions),
              *std::get<Questions<Step>>(step_ask().questions));
    EXPECT_EQ(packet::unpack(step.header, step.body)->data, nullptr);
    auto unknown = step_ask();
    unknown.questions = Questions<Step>(
        std::make_shared<const std::vector<Step>>(std::vector<Step>{{.kind = static_cast<Step::Kind>(99)}}));
    const auto refused = packet::pack(unknown, 0);
    EXPECT_FALSE(packet::unpack(refused.header, refused.body));
    const auto data = packet::pack(data_reply(), 0);
    EXPECT_EQ(*packet::unpack(data.header, data.body)->data, *data_reply().data);
}

// Large ones are brought to a host once, and not to each of its places.
TEST(Packet, TakesSmallResultsAlongWithTheirStep) {
    for (const std::size_t size : {0u, 64'000u, 64'001u}) {
        auto ask = step_ask();
        ask.data = std::make_shared<const std::vector<std::byte>>(size, std::byte{7});
        const auto step = packet::pack(ask, 0);
        const auto got = packet::unpack(step.header, step.body);
        ASSERT_TRUE(got);
        EXPECT_EQ(*std::get<Questions<Step>>(got->questions), *std::get<Questions<Step>>(ask.questions));
        ASSERT_EQ(packet::goes_along(ask.data), size <= 64'000);
        if (packet::goes_along(ask.data))
            EXPECT_EQ(*got->data, *ask.data);
        else
            EXPECT_EQ(got->data, nullptr);
    }
}

TEST(Packet, BringsControlFieldsBackAndIgnoresUnknownOnes) {
    const auto fields = Fields{}.set("places", 4).set("build", "0.1.0").set("future", 9);
    const auto packed = packet::pack(Type::welcome, 3, fields);
    const auto header = packet::read_header(packed.header, packed.body);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->type, Type::welcome);
    const auto got = packet::unpack_fields(packed.body);
    ASSERT_TRUE(got);
    EXPECT_EQ(*got, fields);
    EXPECT_EQ(got->number("absent"), 0u);
    EXPECT_EQ(got->text("absent"), "");
}

std::vector<Packet> corpus() {
    std::vector<Packet> packets;
    for (const auto& message : {light_ask(3), tile_ask(), step_ask(), data_reply(), reply(), dark_reply(), failure()})
        packets.push_back(packet::pack(message, 0));
    packets.push_back(packet::pack(Type::hello, 1, Fields{}.set("build", "x").set("n", 5)));
    return packets;
}

bool accepted(const std::vector<std::byte>& header, const std::vector<std::byte>& body) {
    return packet::unpack(header, body) || (packet::read_header(header, body) && packet::unpack_fields(body));
}

TEST(Packet, BringsPiecesOfFilesBack) {
    const std::vector<std::byte> bytes(1000, std::byte{7});
    const Hash whole = content_hash("a file");
    const Packet sent = packet::pack(9, packet::Piece{whole, 123456789012, bytes});
    const auto header = packet::read_header(sent.header, sent.body);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->type, Type::blob);
    EXPECT_EQ(header->run, 9u);
    const auto piece = packet::unpack_piece(sent.body);
    ASSERT_TRUE(piece);
    EXPECT_EQ(piece->hash, whole);
    EXPECT_EQ(piece->offset, 123456789012u);
    EXPECT_TRUE(std::ranges::equal(piece->bytes, bytes));
    for (std::size_t size = 0; size < sent.body.size(); ++size)
        EXPECT_FALSE(packet::unpack_piece(std::span(sent.body).first(size)));
    EXPECT_FALSE(
        packet::unpack_piece(packet::pack(Type::blob, 9, Fields{}.set("hash", "short").set("offset", 1)).body));
}

TEST(Packet, IsRefusedWhenCutAnywhere) {
    for (const auto& whole : corpus()) {
        for (std::size_t size = 0; size < whole.body.size(); ++size)
            EXPECT_FALSE(accepted(whole.header, {whole.body.begin(), whole.body.begin() + static_cast<long>(size)}));
        for (std::size_t size = 0; size < whole.header.size(); ++size)
            EXPECT_FALSE(accepted({whole.header.begin(), whole.header.begin() + static_cast<long>(size)}, whole.body));
    }
}

TEST(Packet, IsRefusedWhenAnyBitIsFlipped) {
    for (const auto& whole : corpus())
        for (std::size_t bit = 0; bit < 8 * (whole.header.size() + whole.body.size()); ++bit) {
            auto bad = whole;
            auto& byte = bit / 8 < bad.header.size() ? bad.header[bit / 8] : bad.body[bit / 8 - bad.header.size()];
            byte ^= std::byte{1} << (bit % 8);
            EXPECT_FALSE(accepted(bad.header, bad.body)) << "bit " << bit;
        }
}

TEST(Packet, BodyOfGarbageNeverCrashesAndNeverAllocatesMuch) {
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round) {
        std::vector<std::byte> body(random() % 64);
        for (auto& byte : body) byte = static_cast<std::byte>(random());
        packet::unpack_fields(body);
    }
    // An array that claims four billion entries, and nesting without end.
    const std::vector<std::byte> claim{std::byte{0xdd}, std::byte{0xff}, std::byte{0xff}, std::byte{0xff},
                                       std::byte{0xff}};
    EXPECT_FALSE(packet::unpack_fields(claim));
    EXPECT_FALSE(packet::unpack_fields(std::vector<std::byte>(1 << 20, std::byte{0x91})));
}

TEST(Packet, NamesTheVersionThatAStrangerSpeaks) {
    auto packed = packet::pack(Type::hello, 0, {});
    const std::uint16_t future = 9;
    std::memcpy(packed.header.data() + 4, &future, sizeof future);
    EXPECT_FALSE(packet::peek_header(packed.header));
    EXPECT_EQ(packet::claimed_version(packed.header), 9);
    EXPECT_FALSE(packet::claimed_version(std::vector<std::byte>(64, std::byte{'G'})));
}

}  // namespace
}  // namespace lightnet::packet_test
