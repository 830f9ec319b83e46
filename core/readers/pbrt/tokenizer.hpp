// The words of a pbrt file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/readers/common/report.hpp"

namespace lightnet::pbrt {

struct Token {
    enum class Kind { word, text, open, close };  // word: bare; text: was in quotes; open, close: [ and ]
    Kind kind = Kind::word;
    std::string_view raw;  // of the file's bytes; text without its quotes, escapes as written
    int line = 0;
};

/// The characters that the escapes in a quoted text stand for.
std::string unescape(std::string_view raw);
/// The path in a quoted text. Systems on which `\` is between folders wrote many of them, and rarely escaped it.
std::string path_in(std::string_view raw);

/// Cuts the text of one file into tokens. The text must outlive it and its tokens. Broken quotes are reported.
class Tokenizer {
public:
    Tokenizer(std::string file, std::string_view text, Report& report);

    /// The next token, which stays there.
    const std::optional<Token>& peek();
    /// The next token, taken away. None: the file has ended.
    std::optional<Token> next();
    /// Where the reader is: the line of the latest token.
    SourceLine here() const { return {file_, line_of_latest_}; }
    const std::string& file() const { return file_; }

private:
    void skip_space();
    std::optional<Token> scan();
    Token scan_text();

    std::string file_;
    std::string_view text_;
    Report& report_;
    std::size_t at_ = 0;
    int line_ = 1, line_of_latest_ = 1;
    std::optional<Token> peeked_;
    bool has_peeked_ = false;
};

}  // namespace lightnet::pbrt
