#include "transport/zmq/message_frame.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>
#include <zmq.hpp>

#include "core/base/ip_address.hpp"

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

namespace lightnet {
namespace {

static_assert(sizeof(zmq::message_t) == 64 && alignof(zmq::message_t) <= alignof(std::uint64_t),
              "a MessageFrame has room for one");

template <class T>
void free_owned(void*, void* owner) {
    happens_after_sending();
    delete static_cast<T*>(owner);
}

// A frame of memory that `owner` owns, and that goes when the last who holds the frame lets go of it.
template <class T>
void own(void* place, void* data, std::size_t size, std::unique_ptr<T> owner) try {
    new (place) zmq::message_t(data, size, free_owned<T>, owner.get());
    (void)owner.release();
} catch (const zmq::error_t&) {
    throw std::bad_alloc();
}

// The library throws where there is none; that is usual, and asked for each message.
const char* property(const zmq::message_t& message, const char* name) { return zmq_msg_gets(message.handle(), name); }

}  // namespace

#if defined(__SANITIZE_THREAD__)
static char through_sockets;
void happens_before_receiving() { __tsan_release(&through_sockets); }
void happens_after_sending() { __tsan_acquire(&through_sockets); }
#else
void happens_before_receiving() {}
void happens_after_sending() {}
#endif

zmq::message_t& MessageFrame::library() { return *std::launder(reinterpret_cast<zmq::message_t*>(message_.data())); }
const zmq::message_t& MessageFrame::library() const {
    return *std::launder(reinterpret_cast<const zmq::message_t*>(message_.data()));
}

MessageFrame::MessageFrame() noexcept { new (message_.data()) zmq::message_t(); }

MessageFrame::MessageFrame(std::string_view bytes) try {
    new (message_.data()) zmq::message_t(bytes.data(), bytes.size());
} catch (const zmq::error_t&) {
    throw std::bad_alloc();
}

MessageFrame::MessageFrame(std::vector<std::byte>&& bytes) {
    auto owner = std::make_unique<std::vector<std::byte>>(std::move(bytes));
    auto* const data = owner->data();
    const auto size = owner->size();
    own(message_.data(), data, size, std::move(owner));
}

MessageFrame::MessageFrame(Message&& message) {
    auto owner = std::make_unique<Message>(std::move(message));
    auto* const data = owner.get();
    own(message_.data(), data, sizeof(Message), std::move(owner));
}

MessageFrame::~MessageFrame() { library().~message_t(); }

MessageFrame::MessageFrame(MessageFrame&& other) noexcept {
    new (message_.data()) zmq::message_t(std::move(other.library()));
}

// What was here goes at once: it may be much, or hold up a thread that waits for its end.
MessageFrame& MessageFrame::operator=(MessageFrame&& other) noexcept {
    if (this != &other) library().move(other.library());
    return *this;
}

MessageFrame MessageFrame::shared() {
    MessageFrame other;
    other.library().copy(library());
    return other;
}

std::size_t MessageFrame::size() const { return library().size(); }
void* MessageFrame::data() { return library().data(); }
const void* MessageFrame::data() const { return library().data(); }

std::string MessageFrame::peer_address() const {
    const char* address = property(library(), "Peer-Address");
    const auto number = ip_address(address ? address : "");  // of the old family, at a port for both
    return number ? number->text() : address ? address : "";
}

std::string_view MessageFrame::peer_key() const {
    const char* key = property(library(), "User-Id");
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
