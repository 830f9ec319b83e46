// Small things that every user of a socket needs. For the .cpp files of this folder.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/run/message/message.hpp"
#include "transport/wire/packet.hpp"

namespace zmq {
class context_t;
class message_t;
class socket_t;
}  // namespace zmq
struct zmq_pollitem_t;

namespace lightnet {

/// The frames of one message, route first.
using Frames = std::vector<zmq::message_t>;

/// A context with room for as many sockets as the system has descriptors for. Throws Error when there are too few left
/// for any work.
std::unique_ptr<zmq::context_t> make_context(int io_threads = 1);
/// Returns when one of the items has what it waits for, or after `most`, or when the process was sent a signal. Throws
/// zmq::error_t when something is wrong with the items.
void poll(std::vector<zmq_pollitem_t>& items, std::chrono::milliseconds most);
/// To be read.
zmq_pollitem_t readable(zmq::socket_t& socket);
zmq_pollitem_t readable(int descriptor);

/// A socket that binds and answers: knows its peers, refuses those that are gone, never blocks, never lingers.
zmq::socket_t answering_socket(zmq::context_t& context);
/// The same for other hosts: greets each connection with an empty message, so that a peer whose connection was cut
/// knows that what was under way may be lost. Who does not answer its heartbeats is cut off.
zmq::socket_t door_socket(zmq::context_t& context);
/// A socket that connects and asks: one peer only, sends nothing before the peer is there, says hello by itself after
/// each reconnection.
zmq::socket_t asking_socket(zmq::context_t& context, const std::string& endpoint);

/// Sends all frames or none. False: the peer is gone or its queue is full.
bool send_frames(zmq::socket_t& socket, Frames& frames);
/// One whole message, if there is one.
std::optional<Frames> receive_frames(zmq::socket_t& socket);

/// A message of nothing but an empty frame (or a header and a body that are): what was under way may be lost.
bool is_empty(const Frames& frames);
Frames empty_message();

zmq::message_t frame_of(const std::string& bytes);
/// Moves the bytes into the frame: no copy.
zmq::message_t frame_of(std::vector<std::byte>&& bytes);
/// Hands a message over as it is, within the process: the frame owns it, so it can't leak, whatever becomes of the
/// frame.
zmq::message_t frame_of(Message&& message);
/// Takes such a message out of its frame.
Message take_message(zmq::message_t& frame);
/// Puts the packet behind `frames`.
void append(Frames& frames, packet::Packet packet);

std::span<const std::byte> bytes_of(const zmq::message_t& frame);
std::string text_of(const zmq::message_t& frame);

/// Sizes that were agreed on never fill a queue of this many messages; if one is full, something is wrong, and counted.
inline constexpr int high_water_mark = 4096;
/// May a socket that connects have refused because its queue is full, with so many messages on their way? If not, its
/// peer is gone for the moment; it does not tell which.
inline bool may_be_full(std::size_t under_way) { return under_way >= std::size_t{high_water_mark} / 2; }

}  // namespace lightnet
