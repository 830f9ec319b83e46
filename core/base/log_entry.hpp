// Log entries of programs that run for long.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace lightnet {

enum class LogLevel { info, warning, error };

/// A value. Made of a text alone, it is no more than worth knowing.
struct LogEntry {
    LogEntry(std::string said) : text(std::move(said)) {}  // NOLINT: a text is an entry
    LogEntry(const char* said) : text(said) {}             // NOLINT
    LogEntry(LogLevel how, std::string said) : level(how), text(std::move(said)) {}

    LogLevel level = LogLevel::info;
    std::string text;
    std::optional<std::uint64_t> run = std::nullopt;  // of which it tells
};

}  // namespace lightnet
