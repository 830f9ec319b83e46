#include "core/readers/pbrt/tokenizer.hpp"

#include <utility>

#include "core/readers/files/trimmed.hpp"

namespace lightnet::pbrt {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

char escaped(char c) {
    switch (c) {
        case 'n':
            return '\n';
        case 't':
            return '\t';
        case 'r':
            return '\r';
        case 'b':
            return '\b';
        case 'f':
            return '\f';
        default:
            return c;  // \" \\ \'
    }
}

}  // namespace

std::string unescape(std::string_view raw) {
    std::string text;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        const bool escape = raw[i] == '\\' && i + 1 < raw.size();
        text += escape ? escaped(raw[++i]) : raw[i];
    }
    return text;
}

std::string path_in(std::string_view raw) {
    std::string path;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        const char next = i + 1 < raw.size() ? raw[i + 1] : ' ';
        const bool backslash = raw[i] == '\\', quote = backslash && next == '"';
        path += quote ? '"' : backslash ? '/' : raw[i];
        if (quote || (backslash && next == '\\')) ++i;
    }
    return path;
}

Tokenizer::Tokenizer(std::string file, std::string_view text, Report& report)
    : file_(std::move(file)), text_(without_byte_order_mark(text)), report_(report) {}

const std::optional<Token>& Tokenizer::peek() {
    if (!has_peeked_) peeked_ = scan();
    has_peeked_ = true;
    return peeked_;
}

std::optional<Token> Tokenizer::next() {
    auto token = peek();
    has_peeked_ = false;
    if (token) line_of_latest_ = token->line;
    return token;
}

void Tokenizer::skip_space() {
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '#')
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        if (at_ == text_.size() || !is_space(text_[at_])) return;
        if (text_[at_] == '\n') ++line_;
    }
}

std::optional<Token> Tokenizer::scan() {
    skip_space();
    if (at_ == text_.size()) return std::nullopt;
    const std::size_t start = at_;
    switch (text_[at_]) {
        case '[':
            ++at_;
            return Token{Token::Kind::open, text_.substr(start, 1), line_};
        case ']':
            ++at_;
            return Token{Token::Kind::close, text_.substr(start, 1), line_};
        case '"':
            return scan_text();
        default:
            break;
    }
    while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
    return Token{Token::Kind::word, text_.substr(start, at_ - start), line_};
}

Token Tokenizer::scan_text() {
    const std::size_t start = ++at_;
    while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') {
        const bool escape = text_[at_] == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n';
        at_ += escape ? 2 : 1;
    }
    const Token token{Token::Kind::text, text_.substr(start, at_ - start), line_};
    if (at_ < text_.size() && text_[at_] == '"')
        ++at_;
    else
        report_.error({file_, line_}, "a quote is opened, but not closed on its line");
    return token;
}

}  // namespace lightnet::pbrt
