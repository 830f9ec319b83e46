// Questions as columns: what the body of a packet holds for each member of a question.
//
// A column is a `bin` with one entry per question; whole numbers take 1, 2 or 4 bytes each, whichever all of them fit
// into. A whole number that is the same for all questions is written once, as a number. So a question about a scene of
// usual size takes 30 to 36 bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/run/message/message.hpp"

namespace lightnet::packet {

inline constexpr std::size_t most_questions = 1 << 16;  // in one bundle

void pack_columns(const std::vector<Query>& questions, std::vector<std::byte>& body);
void pack_columns(const std::vector<Tile>& tiles, std::vector<std::byte>& body);
/// `data`: what the steps name, if it goes along.
void pack_columns(const std::vector<Step>& steps, const Bytes& data, std::vector<std::byte>& body);

/// What goes along with steps; null: nothing.
Bytes unpack_data(std::span<const std::byte> body);

/// Reads `count` questions. None: there are others in `body`, or something else. Makes room only for what is there.
template <class Question>
std::optional<Questions<Question>> unpack_columns(std::size_t count, std::span<const std::byte> body);

extern template std::optional<Questions<Query>> unpack_columns<Query>(std::size_t, std::span<const std::byte>);
extern template std::optional<Questions<Tile>> unpack_columns<Tile>(std::size_t, std::span<const std::byte>);
extern template std::optional<Questions<Step>> unpack_columns<Step>(std::size_t, std::span<const std::byte>);

}  // namespace lightnet::packet
