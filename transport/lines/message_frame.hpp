// The frames that messages are made of.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/run/message/message.hpp"
#include "transport/wire/packet.hpp"

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
    /// Memory of others, that goes with the last `owner`.
    MessageFrame(std::shared_ptr<const void> owner, void* data, std::size_t size) noexcept;
    MessageFrame(MessageFrame&& other) noexcept;
    MessageFrame& operator=(MessageFrame&& other) noexcept;

    /// Another frame of the same bytes, which both own: no copy if they are many.
    MessageFrame shared() const;
    std::size_t size() const { return size_; }
    void* data() { return owner_ ? data_ : small_.data(); }
    const void* data() const { return owner_ ? data_ : small_.data(); }
    /// Of its memory, which stays where it is as long as there is one; null: these are few bytes, to be copied.
    const std::shared_ptr<const void>& owner() const { return owner_; }
    /// So many bytes are copied rather than owned.
    static constexpr std::size_t most_small = 32;

private:
    std::shared_ptr<const void> owner_;
    void* data_ = nullptr;
    std::size_t size_ = 0;
    std::array<std::byte, most_small> small_;
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

}  // namespace lightnet
