#include "transport/wire/packet.hpp"

#include <cstring>
#include <memory>
#include <type_traits>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "transport/wire/body.hpp"
#include "transport/wire/colours.hpp"
#include "transport/wire/columns.hpp"

namespace lightnet::packet {
namespace {

using Buffer = std::vector<std::byte>;
using View = std::span<const std::byte>;

// ---- header ---------------------------------------------------------------------------------------------------------

class Writer {
public:
    explicit Writer(Buffer& out) : out_(out) {}
    template <class T>
    void put(T value) {
        const auto* bytes = reinterpret_cast<const std::byte*>(&value);
        out_.insert(out_.end(), bytes, bytes + sizeof value);
    }

private:
    Buffer& out_;
};

class Reader {
public:
    explicit Reader(View in) : in_(in) {}
    template <class T>
    T get() {
        T value;
        std::memcpy(&value, in_.data(), sizeof value);
        in_ = in_.subspan(sizeof value);
        return value;
    }

private:
    View in_;
};

constexpr std::size_t checksum_at = header_size - sizeof(std::uint64_t);

std::uint64_t checksum(View header, View body) {
    return XXH3_64bits_withSeed(body.data(), body.size(), XXH3_64bits(header.data(), checksum_at));
}

Buffer write_header(const Header& header, View body) {
    Buffer out;
    out.reserve(header_size);
    Writer writer(out);
    writer.put(magic);
    writer.put(version);
    writer.put(static_cast<std::uint8_t>(header.type));
    writer.put(std::uint8_t{0});
    writer.put(header.run);
    writer.put(header.bundle);
    writer.put(header.channel);
    writer.put(header.node);
    writer.put(header.place);
    writer.put(header.width);
    writer.put(header.count);
    writer.put(header.fill);
    writer.put(header.service_ns);
    writer.put(header.edition);
    writer.put(static_cast<std::uint32_t>(body.size()));
    writer.put(checksum(out, body));
    return out;
}

// ---- body -----------------------------------------------------------------------------------------------------------

bool sane(const Tile& tile) {
    constexpr std::uint32_t most = 1 << 16;
    return tile.width > 0 && tile.height > 0 && tile.pixels() <= most && tile.x < most && tile.y < most &&
           tile.samples > 0 && tile.samples <= samples_per_block * blocks_per_group &&
           tile.first_sample % samples_per_block == 0 &&
           (!tile.coarse || (tile.stride > 0 && tile.samples <= samples_per_block));
}

bool sane(const Step& step) { return step.kind <= Step::Kind::last; }
bool sane(const Query&) { return true; }

template <class Question>
bool take_questions(const Header& header, View body, Message& message) {
    message.load = {};
    message.asker = (std::uint64_t{header.service_ns} << 32) | header.fill;
    auto questions = unpack_columns<Question>(header.count, body);
    if (!questions) return false;
    for (const auto& question : **questions)
        if (!sane(question)) return false;
    message.questions = std::move(*questions);
    return true;
}

Packet finish(const Header& header, Buffer body) { return {write_header(header, body), std::move(body)}; }

Message message_of(const Header& header) {
    Message message;
    message.run = header.run;
    message.channel = header.channel;
    message.bundle = header.bundle;
    message.node = header.node;
    message.width = header.width;
    message.load = {header.fill, header.service_ns};
    message.edition = header.edition;
    return message;
}

}  // namespace

std::optional<std::uint16_t> claimed_version(View header) {
    if (header.size() < 6) return std::nullopt;
    Reader reader(header);
    if (reader.get<std::uint32_t>() != magic) return std::nullopt;
    return reader.get<std::uint16_t>();
}

std::optional<Header> peek_header(View bytes) {
    if (bytes.size() != header_size || claimed_version(bytes) != version) return std::nullopt;
    Reader reader(bytes.subspan(6));
    const auto type = reader.get<std::uint8_t>();
    reader.get<std::uint8_t>();
    if (type == 0 || type > static_cast<std::uint8_t>(Type::last)) return std::nullopt;
    Header header;
    header.type = static_cast<Type>(type);
    header.run = reader.get<std::uint64_t>();
    header.bundle = reader.get<std::uint64_t>();
    header.channel = reader.get<std::uint32_t>();
    header.node = reader.get<std::uint32_t>();
    header.place = reader.get<std::uint32_t>();
    header.width = reader.get<std::uint32_t>();
    header.count = reader.get<std::uint32_t>();
    header.fill = reader.get<std::uint32_t>();
    header.service_ns = reader.get<std::uint32_t>();
    header.edition = reader.get<std::uint32_t>();
    return header;
}

std::optional<Header> read_header(View bytes, View body) {
    auto header = peek_header(bytes);
    if (!header || body.size() > most_bytes) return std::nullopt;
    Reader tail(bytes.subspan(checksum_at - sizeof(std::uint32_t)));
    if (tail.get<std::uint32_t>() != body.size()) return std::nullopt;
    if (tail.get<std::uint64_t>() != checksum(bytes, body)) return std::nullopt;
    return header;
}

Packet pack(const Message& message, std::uint32_t place) {
    Header header;
    header.run = message.run, header.bundle = message.bundle, header.channel = message.channel;
    header.node = message.node, header.place = place, header.width = message.width;
    header.fill = message.load.fill, header.service_ns = message.load.service_ns;
    header.edition = message.edition;
    Buffer body;
    const auto ask = [&](Type type, const auto& questions) {
        header.type = type;
        header.fill = static_cast<std::uint32_t>(message.asker);
        header.service_ns = static_cast<std::uint32_t>(message.asker >> 32);
        header.count = static_cast<std::uint32_t>(questions->size());
        if constexpr (std::is_same_v<decltype(questions), const Questions<Step>&>)
            pack_columns(*questions, goes_along(message.data) ? message.data : nullptr, body);
        else
            pack_columns(*questions, body);
    };
    if (message.type == Message::Type::failure) {
        header.type = Type::failure;
        body = pack(Type::failure, message.run,
                    Fields{}.set("text", message.trouble.why).set("host", message.trouble.host))
                   .body;
    } else if (message.type == Message::Type::reply && message.data) {
        header.type = Type::data;
        body.reserve(message.data->size() + 16);
        BodyWriter(body, 1).bytes("data", *message.data);
    } else if (message.type == Message::Type::reply) {
        header.type = Type::answers;
        header.count = static_cast<std::uint32_t>(message.answers.size());
        pack_colours(message.answers, body);
    } else if (const auto* queries = std::get_if<Questions<Query>>(&message.questions)) {
        ask(Type::ask_light, *queries);
    } else if (const auto* tiles = std::get_if<Questions<Tile>>(&message.questions)) {
        ask(Type::ask_pixels, *tiles);
    } else {
        ask(Type::ask_step, std::get<Questions<Step>>(message.questions));
    }
    return finish(header, std::move(body));
}

std::optional<Message> unpack(View header_bytes, View body) {
    const auto header = read_header(header_bytes, body);
    if (!header) return std::nullopt;
    Message message = message_of(*header);
    switch (header->type) {
        case Type::ask_light:
            if (!take_questions<Query>(*header, body, message)) return std::nullopt;
            return message;
        case Type::ask_pixels:
            if (!take_questions<Tile>(*header, body, message)) return std::nullopt;
            return message;
        case Type::ask_step:
            if (!take_questions<Step>(*header, body, message)) return std::nullopt;
            message.data = unpack_data(body);
            return message;
        case Type::data: {
            const BodyReader map(body);
            const auto bytes = map.good() ? map.bytes("data") : std::nullopt;
            if (!bytes) return std::nullopt;
            message.type = Message::Type::reply;
            message.data = std::make_shared<const std::vector<std::byte>>(bytes->begin(), bytes->end());
            return message;
        }
        case Type::answers: {
            auto colours = unpack_colours(header->count, body);
            if (!colours) return std::nullopt;
            message.type = Message::Type::reply;
            message.answers = std::move(*colours);
            return message;
        }
        case Type::failure: {
            const auto fields = unpack_fields(body);
            if (!fields) return std::nullopt;
            message.type = Message::Type::failure;
            message.trouble = {fields->text("text"), fields->text("host")};
            return message;
        }
        default:
            return std::nullopt;
    }
}

Fields& Fields::set(const std::string& key, std::uint64_t number) {
    numbers[key] = number;
    return *this;
}

Fields& Fields::set(const std::string& key, std::string_view text) {
    texts[key] = text;
    return *this;
}

std::uint64_t Fields::number(const std::string& key) const {
    const auto found = numbers.find(key);
    return found == numbers.end() ? 0 : found->second;
}

const std::string& Fields::text(const std::string& key) const {
    static const std::string empty;
    const auto found = texts.find(key);
    return found == texts.end() ? empty : found->second;
}

Packet pack(Type type, std::uint64_t run, const Fields& fields) {
    Buffer body;
    BodyWriter writer(body, fields.numbers.size() + fields.texts.size());
    for (const auto& [name, number] : fields.numbers) writer.number(name, number);
    for (const auto& [name, text] : fields.texts) writer.bytes(name, std::as_bytes(std::span(text)));
    Header header;
    header.type = type;
    header.run = run;
    return finish(header, std::move(body));
}

Packet pack(std::uint64_t run, const Piece& piece) {
    constexpr std::size_t rest = 128;  // names, hash and offset
    Buffer body;
    body.reserve(piece.bytes.size() + rest);
    BodyWriter writer(body, 3);
    writer.number("offset", piece.offset);
    writer.bytes("bytes", piece.bytes);
    writer.bytes("hash", std::as_bytes(std::span(piece.hash.bytes)));
    Header header;
    header.type = Type::blob;
    header.run = run;
    return finish(header, std::move(body));
}

std::optional<Piece> unpack_piece(View body) {
    const BodyReader map(body);
    if (!map.good()) return std::nullopt;
    const auto offset = map.number("offset");
    const auto bytes = map.bytes("bytes"), hash = map.bytes("hash");
    Piece piece;
    if (!offset || !bytes || !hash || hash->size() != piece.hash.bytes.size()) return std::nullopt;
    std::memcpy(piece.hash.bytes.data(), hash->data(), hash->size());
    piece.offset = *offset;
    piece.bytes = *bytes;
    return piece;
}

Packet pack(std::uint64_t run, const Part& part) {
    Header header;
    header.type = Type::part, header.run = run;
    header.bundle = part.offset, header.count = part.whole;
    return finish(header, {part.bytes.begin(), part.bytes.end()});
}

std::optional<Part> part_of(const Header& header, View body) {
    constexpr std::size_t most_else = 64 << 10;  // in a message, besides a body
    if (header.count > most_bytes + most_else || header.bundle > header.count || body.empty() ||
        body.size() > header.count - header.bundle)
        return std::nullopt;
    return Part{header.bundle, header.count, body};
}

Packet pack(Type type, std::uint64_t mark) {
    Header header;
    header.type = type, header.bundle = mark;
    return finish(header, {});
}

std::optional<Fields> unpack_fields(View body) {
    if (body.size() > most_bytes) return std::nullopt;
    const BodyReader map(body);
    if (!map.good()) return std::nullopt;
    Fields fields;
    for (const auto& [name, number] : map.all_numbers()) fields.set(std::string(name), number);
    for (const auto& [name, bytes] : map.all_bytes())
        fields.set(std::string(name), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return fields;
}

}  // namespace lightnet::packet
