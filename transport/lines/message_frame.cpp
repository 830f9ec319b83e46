#include "transport/lines/message_frame.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lightnet {

static_assert(sizeof(Message) > MessageFrame::most_small, "one that is handed over stays where it is");

MessageFrame::MessageFrame() noexcept = default;

MessageFrame::MessageFrame(std::string_view bytes) : size_(bytes.size()) {
    if (size_ > most_small) {
        auto owner = std::make_shared<std::string>(bytes);
        data_ = owner->data();
        owner_ = std::move(owner);
    } else {
        std::copy_n(bytes.data(), size_, reinterpret_cast<char*>(small_.data()));
    }
}

MessageFrame::MessageFrame(std::vector<std::byte>&& bytes) : size_(bytes.size()) {
    auto owner = std::make_shared<std::vector<std::byte>>(std::move(bytes));
    data_ = owner->data();
    owner_ = std::move(owner);
}

MessageFrame::MessageFrame(Message&& message) : size_(sizeof(Message)) {
    auto owner = std::make_shared<Message>(std::move(message));
    data_ = owner.get();
    owner_ = std::move(owner);
}

MessageFrame::MessageFrame(std::shared_ptr<const void> owner, void* data, std::size_t size) noexcept
    : owner_(std::move(owner)), data_(data), size_(size) {}

MessageFrame::MessageFrame(MessageFrame&& other) noexcept
    : owner_(std::move(other.owner_)), data_(other.data_), size_(std::exchange(other.size_, 0)), small_(other.small_) {}

// What was here goes at once: it may be much, or hold up a thread that waits for its end.
MessageFrame& MessageFrame::operator=(MessageFrame&& other) noexcept {
    if (this == &other) return *this;
    owner_ = std::move(other.owner_);
    data_ = other.data_;
    size_ = std::exchange(other.size_, 0);
    small_ = other.small_;
    return *this;
}

MessageFrame MessageFrame::shared() const {
    MessageFrame other(owner_, data_, size_);
    other.small_ = small_;
    return other;
}

bool is_empty(const Frames& frames) {
    return frames.size() <= 2 && std::all_of(frames.begin(), frames.end(), [](const auto& f) { return f.size() == 0; });
}

Frames empty_message() {
    Frames frames;
    frames.emplace_back();
    return frames;
}

Frames frames_of(Message&& message) {
    Frames frames;
    frames.emplace_back(std::move(message));
    return frames;
}

Message take_message(MessageFrame& frame) { return std::move(*static_cast<Message*>(frame.data())); }

Frames frames_of(packet::Packet packet) {
    Frames frames;
    append(frames, std::move(packet));
    return frames;
}

void append(Frames& frames, packet::Packet packet) {
    frames.emplace_back(std::move(packet.header));
    frames.emplace_back(std::move(packet.body));
}

std::span<const std::byte> bytes_of(const MessageFrame& frame) {
    return {static_cast<const std::byte*>(frame.data()), frame.size()};
}

std::string text_of(const MessageFrame& frame) { return {static_cast<const char*>(frame.data()), frame.size()}; }

}  // namespace lightnet
