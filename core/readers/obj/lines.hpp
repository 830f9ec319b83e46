// The lines and words of OBJ and MTL files.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/readers/common/report.hpp"
#include "core/readers/files/trimmed.hpp"

namespace lightnet::obj {

/// Reads a text line by line: without remarks, with lines joined that a backslash continues. What it hands out lives
/// until the next line.
class Lines {
public:
    Lines(std::span<const std::byte> bytes, std::string file)
        : text_(without_byte_order_mark({reinterpret_cast<const char*>(bytes.data()), bytes.size()})),
          file_(std::move(file)) {}

    /// The next line that says anything; none: the end.
    bool next();
    /// What rest() would give, which stays.
    std::string_view left() const { return left_; }
    /// Goes on with words of a line that was read before, as long as they are there.
    void begin(std::string_view words, int line) { left_ = words, line_ = line; }
    /// The next word of the line; "": there is none.
    std::string_view word();
    /// What is left of the line, without spaces at its ends.
    std::string_view rest();
    /// The next word as a finite number. None: there is no word, or it was reported as no number.
    std::optional<float> number(Report& report);

    SourceLine where() const { return {file_, line_}; }

private:
    std::string_view cut();

    std::string_view text_;
    std::string file_, joined_;
    std::string_view left_;
    std::size_t at_ = 0;
    int line_ = 0, ended_ = 0;
};

}  // namespace lightnet::obj
