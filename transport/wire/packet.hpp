// The protocol, on one page. ROUTER answers, DEALER asks. On the wire a packet is two frames, behind the route (and, on
// its way through the launcher, behind the sealed address of relay_address.hpp):
//
//   header   68 bytes, little-endian, in the order of the members of Header
//   body     a msgpack map. Asks: columns, see columns.hpp. Replies: colours, see colours.hpp. Control: small maps
//            of numbers and texts; unknown keys are skipped.
//
// What is large goes in parts of its bytes (all frames, each behind its length), so that no line is busy with it for
// long, and both ends of a line ask each other now and then how far they have got, see paced_line.hpp.
//
// A message of one empty frame instead: a connection was made, or a packet was damaged; what was under way may be lost.
//
// `run` in the header is a random number that a run tells its members alone. What does not name it is not of that run:
// nobody else can plan, end, feed or question it. Strangers are told 0.
//
// Every size is checked before anything is allocated, and a packet that breaks a rule is dropped and counted.
// Version 4. A peer of another version is refused at HELLO, with a text that names both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"
#include "core/run/message/message.hpp"
#include "transport/wire/columns.hpp"

namespace lightnet::packet {

inline constexpr std::uint32_t magic = 0x54454e4c;  // "LNET"
inline constexpr std::uint16_t version = 4;
inline constexpr std::size_t header_size = 68;
inline constexpr std::size_t most_bytes = 64 << 20;  // in one body

enum class Type : std::uint8_t {
    // work: goes through to a place
    ask_light = 1,  // columns of Query → answers
    ask_pixels,     // columns of Tile → answers
    answers,        // colours
    failure,        // text
    ask_step,       // columns of Step → data
    data,           // bytes
    // control: launcher → host                       host → launcher
    hello = 16,  // version, build, isa
    welcome,     //                             places, process, fingerprint
    refuse,      //                             text: what differs, or who is being served
    begin,       // graph, plan, seed, rules, manifest of the scene's files, who, members, numbers
    need,        //                             hashes that are not in the host's cache
    blob,        // hash, offset, bytes. From host to host, too: what was asked by fetch
    blob_taken,  //                             hash, offset
    ready,       //                             all places are assembled
    broken,      //                             text: the run can't be served here
    ping,        // heartbeat; sent: messages so far, see is_counted(); watch: figures are wanted
    pong,  //                          process, run, progress, pulse, sent (as in pings), taken, told, line, figures,
    //                                         peak_memory
    plan,     // who answers for which node from now on
    end,      // of the run
    ended,    //                             counters, peak_memory
    leaving,  // it is to leave the run           it was told to: it answers what it has, then ends the run
    join,     //                             name, process, endpoint, proof: "I am here", from a host that dialled out
    joined,   // to such a host: challenge, see pass.hpp; turned_down
    expect,   // hash, size: bytes that a step will name; holders: hosts that have them, a line each
    lacks,    //                             hash: please send them. From host to host: it can't give them
    here,     //                             hash: it has them
    fault,    //                             host, text: another host that failed at what this one asked of it
    // anyone → a host or a launcher
    status,
    state,    // a host in words; `left` more follow
    members,  // launcher → host, for this run only: the keys of its hosts, see AllowList; numbers: where those are
              // that have names, a line each, like "onyx1 10.0.0.11"
    fetch,    // host → host, behind an address like an ask: hash, offset, size: a piece of a result, please
    // either end of a line, about the line; all in the header
    part,     // of a message: bundle: where it begins; count: bytes of the whole. The body is nothing but its bytes
    mark,     // bundle: a number, to be said back by whoever gets so far
    marked,   // it has come so far
    unpaced,  // marks are not answered in time here: what comes back goes at once
    last = unpaced,
};

constexpr bool is_ask(Type type) {
    return type == Type::ask_light || type == Type::ask_pixels || type == Type::ask_step;
}
/// Both ends of a connection between launcher and host count these, as nothing else would tell that one has vanished.
constexpr bool is_counted(Type type) {
    switch (type) {
        case Type::need:
        case Type::ready:
        case Type::plan:
        case Type::members:
        case Type::leaving:
        case Type::expect:
        case Type::lacks:
        case Type::here:
        case Type::fault:
            return true;
        default:
            return type < Type::hello;
    }
}
/// Goes on a line in its turn, behind what was sent before. Others are small, and show that an end is alive: at once.
constexpr bool waits_its_turn(Type type) {
    return is_counted(type) || type == Type::begin || type == Type::end || type == Type::ended;
}
constexpr bool is_reply(Type type) { return type < Type::hello && !is_ask(type); }

/// The fixed part of a packet. Never trusted before magic, version, size and checksum have been checked.
struct Header {
    Type type = Type::ping;
    std::uint64_t run = 0;
    std::uint64_t bundle = 0;
    std::uint32_t channel = 0;
    std::uint32_t node = 0;
    std::uint32_t place = 0;       // of the host
    std::uint32_t width = 0;       // colours per question
    std::uint32_t count = 0;       // questions, or colours of an answer
    std::uint32_t fill = 0;        // questions that wait at the answerer; in an ask, with the next: who asks
    std::uint32_t service_ns = 0;  // per question
    std::uint32_t edition = 0;     // of an ask: of the plan by which the asker goes
};

/// Header and body, ready to be sent.
struct Packet {
    std::vector<std::byte> header;
    std::vector<std::byte> body;
};

/// Reads a header, and checks it against its body. None: not ours, another version, or damaged.
std::optional<Header> read_header(std::span<const std::byte> header, std::span<const std::byte> body);
/// Reads a header without looking at the body: enough to route by.
std::optional<Header> peek_header(std::span<const std::byte> header);
/// The version a header claims, if it is a header at all: for a refusal that names it.
std::optional<std::uint16_t> claimed_version(std::span<const std::byte> header);

/// What a step names, a result, goes along with it when it is small. Else it must have been brought to the host before,
/// where all places share it.
inline bool goes_along(const Bytes& result) { return result && result->size() <= 64000; }

/// An ask, a reply or a failure, for `place` of a host.
Packet pack(const Message& message, std::uint32_t place);
/// Reads it back; the route is left empty. None: damaged, or sizes that don't fit.
std::optional<Message> unpack(std::span<const std::byte> header, std::span<const std::byte> body);

/// What a control packet says.
class Fields {
public:
    Fields& set(const std::string& key, std::uint64_t number);
    Fields& set(const std::string& key, std::string_view text);
    /// 0 / empty when absent.
    std::uint64_t number(const std::string& key) const;
    const std::string& text(const std::string& key) const;

    std::map<std::string, std::uint64_t> numbers;
    std::map<std::string, std::string> texts;  // text or bytes
    friend bool operator==(const Fields&, const Fields&) = default;
};

Packet pack(Type type, std::uint64_t run, const Fields& fields);

/// A piece of a blob (a file or a result, named by its content); its bytes are a view.
struct Piece {
    Hash hash;  // of the whole
    std::uint64_t offset = 0;
    std::span<const std::byte> bytes;
};

Packet pack(std::uint64_t run, const Piece& piece);
/// The piece of a blob packet whose header has been read, in `body`. None: damaged.
std::optional<Piece> unpack_piece(std::span<const std::byte> body);

/// A part of a message, as bytes; they are a view.
struct Part {
    std::uint64_t offset = 0;
    std::uint32_t whole = 0;  // bytes
    std::span<const std::byte> bytes;
};

Packet pack(std::uint64_t run, const Part& part);
/// Of a part packet whose header has been read. None: it does not fit into its message.
std::optional<Part> part_of(const Header& header, std::span<const std::byte> body);
/// A mark, or the answer to one.
Packet pack(Type type, std::uint64_t mark);

/// The fields of a control packet whose header has been read. None: damaged.
std::optional<Fields> unpack_fields(std::span<const std::byte> body);

}  // namespace lightnet::packet
