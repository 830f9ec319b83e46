#include "core/base/printable.hpp"

#include <algorithm>
#include <cstddef>

namespace lightnet {
namespace {

unsigned byte(char c) { return static_cast<unsigned char>(c); }

// Neither longer than it need be, nor half of a pair of UTF-16, nor beyond the last letter.
bool may_follow(unsigned first, unsigned second) {
    const unsigned least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    const unsigned most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    return least <= second && second <= most;
}

// How many bytes the character at the front has; 0: it is none.
std::size_t length_of_character(std::string_view text) {
    const unsigned first = byte(text[0]);
    const std::size_t length = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (first > 0xF4 || length > text.size()) return 0;
    const auto more = text.substr(std::min<std::size_t>(1, length), length - (length > 0));
    const bool whole = std::all_of(more.begin(), more.end(), [](char c) { return (byte(c) & 0xC0) == 0x80; });
    return whole && (length < 2 || may_follow(first, byte(text[1]))) ? length : 0;
}

// ASCII's, and those of ISO 6429 that some terminals obey in UTF-8 as well.
bool commands(std::string_view character) {
    if (character.size() == 1) return byte(character[0]) < 0x20 || byte(character[0]) == 0x7F;
    return character.size() == 2 && byte(character[0]) == 0xC2 && byte(character[1]) < 0xA0;
}

}  // namespace

std::string printable(std::string_view text, bool lines) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string result;
    while (!text.empty()) {
        const std::size_t length = length_of_character(text);
        const auto character = text.substr(0, std::max<std::size_t>(1, length));
        const bool stays = lines && (character == "\n" || character == "\t");
        if (length > 0 && (stays || !commands(character)))
            result += character;
        else
            for (const char c : character) (result += "\\x") += {digits[byte(c) >> 4], digits[byte(c) & 15]};
        text.remove_prefix(character.size());
    }
    return result;
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const auto length = length_of_character(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string in_utf8(const std::string& text) { return is_utf8(text) ? text : printable(text, true); }

}  // namespace lightnet
