#include "transport/zmq/message_frame.hpp"

#include <zmq.h>
#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "core/base/ip_address.hpp"

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

namespace lightnet {
namespace {

static_assert(sizeof(zmq_msg_t) == 64 && alignof(zmq_msg_t) <= alignof(std::uint64_t),
              "a MessageFrame has room for one");

template <class T>
void free_owned(void*, void* owner) {
    happens_after_sending();
    delete static_cast<T*>(owner);
}

// A frame of memory that `owner` owns, and that goes when the last who holds the frame lets go of it.
template <class T>
void own(zmq_msg_t* message, void* data, std::size_t size, std::unique_ptr<T> owner) {
    if (zmq_msg_init_data(message, data, size, free_owned<T>, owner.get()) != 0) throw std::bad_alloc();
    (void)owner.release();
}

}  // namespace

#if defined(__SANITIZE_THREAD__)
static char through_sockets;
void happens_before_receiving() { __tsan_release(&through_sockets); }
void happens_after_sending() { __tsan_acquire(&through_sockets); }
#else
void happens_before_receiving() {}
void happens_after_sending() {}
#endif

zmq_msg_t* MessageFrame::library() { return reinterpret_cast<zmq_msg_t*>(message_.data()); }
const zmq_msg_t* MessageFrame::library() const { return reinterpret_cast<const zmq_msg_t*>(message_.data()); }

MessageFrame::MessageFrame() noexcept { zmq_msg_init(library()); }

MessageFrame::MessageFrame(std::string_view bytes) {
    if (zmq_msg_init_size(library(), bytes.size()) != 0) throw std::bad_alloc();
    if (!bytes.empty()) std::memcpy(data(), bytes.data(), bytes.size());
}

MessageFrame::MessageFrame(std::vector<std::byte>&& bytes) {
    auto owner = std::make_unique<std::vector<std::byte>>(std::move(bytes));
    auto* const data = owner->data();
    const auto size = owner->size();
    own(library(), data, size, std::move(owner));
}

MessageFrame::MessageFrame(Message&& message) {
    auto owner = std::make_unique<Message>(std::move(message));
    auto* const data = owner.get();
    own(library(), data, sizeof(Message), std::move(owner));
}

MessageFrame::~MessageFrame() { zmq_msg_close(library()); }

MessageFrame::MessageFrame(MessageFrame&& other) noexcept : MessageFrame() { zmq_msg_move(library(), other.library()); }

MessageFrame& MessageFrame::operator=(MessageFrame&& other) noexcept {
    if (this != &other) zmq_msg_move(library(), other.library());
    return *this;
}

MessageFrame MessageFrame::shared() {
    MessageFrame other;
    zmq_msg_copy(other.library(), library());
    return other;
}

std::size_t MessageFrame::size() const { return zmq_msg_size(library()); }
void* MessageFrame::data() { return zmq_msg_data(library()); }
const void* MessageFrame::data() const { return zmq_msg_data(const_cast<zmq_msg_t*>(library())); }

std::string MessageFrame::peer_address() const {
    const char* address = zmq_msg_gets(library(), "Peer-Address");
    const auto number = ip_address(address ? address : "");  // of the old family, at a port for both
    return number ? number->text() : address ? address : "";
}

std::string_view MessageFrame::peer_key() const {
    const char* key = zmq_msg_gets(library(), "User-Id");
    return key ? key : "";
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
