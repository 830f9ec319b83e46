// The frames that messages are made of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/run/message/message.hpp"
#include "transport/wire/packet.hpp"

namespace zmq {
class message_t;
}

namespace lightnet {

/// Some bytes on their way. Moved by pointer, never copied unawares.
class MessageFrame {
public:
    MessageFrame() noexcept;
    explicit MessageFrame(std::string_view bytes);
    /// Moves the bytes into the frame: no copy.
    explicit MessageFrame(std::vector<std::byte>&& bytes);
    /// Hands a message over as it is, within the process: the frame owns it, so it can't leak, whatever becomes of the
    /// frame. See take_message().
    explicit MessageFrame(Message&& message);
    ~MessageFrame();
    MessageFrame(MessageFrame&& other) noexcept;
    MessageFrame& operator=(MessageFrame&& other) noexcept;

    /// Another frame of the same bytes, which both own: no copy if they are many.
    MessageFrame shared();
    std::size_t size() const;
    void* data();
    const void* data() const;
    /// The network address that it came from; empty: not from a network.
    std::string peer_address() const;
    /// The public key, as text, of whom it came from; empty: it came without.
    std::string_view peer_key() const;
    /// The library's own, for sockets.
    zmq::message_t& library();

private:
    const zmq::message_t& library() const;
    alignas(std::uint64_t) std::array<std::byte, 64> message_;  // a zmq::message_t
};

/// The frames of one message, route first.
using Frames = std::vector<MessageFrame>;

/// A message of nothing but an empty frame (or a header and a body that are): what was under way may be lost.
bool is_empty(const Frames& frames);
Frames empty_message();

/// One frame that hands a message over as it is.
Frames frames_of(Message&& message);
/// Takes such a message out of its frame.
Message take_message(MessageFrame& frame);
/// Header and body.
Frames frames_of(packet::Packet packet);
/// Puts the packet behind `frames`.
void append(Frames& frames, packet::Packet packet);

std::span<const std::byte> bytes_of(const MessageFrame& frame);
std::string text_of(const MessageFrame& frame);

/// Happens-before, told to the thread sanitizer, which can't see into the library: what a thread did before it sent a
/// message is done when another receives it, or frees its memory.
void happens_before_receiving();
void happens_after_sending();

}  // namespace lightnet
