#include "core/readers/pbrt/syntax.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

/// What stands behind a directive.
struct Form {
    int numbers = 0;
    int least_names = 0, most_names = 0;
    bool parameters = false;
    bool bare = false;  // names may stand without quotes
};

const std::map<std::string, Form, std::less<>>& forms() {
    constexpr Form nothing{}, name{0, 1, 1}, typed{0, 1, 1, true};
    static const std::map<std::string, Form, std::less<>> table{{"Accelerator", typed},
                                                                {"ActiveTransform", {0, 1, 1, false, true}},
                                                                {"AreaLightSource", typed},
                                                                {"Attribute", typed},
                                                                {"AttributeBegin", nothing},
                                                                {"AttributeEnd", nothing},
                                                                {"Camera", typed},
                                                                {"ColorSpace", name},
                                                                {"ConcatTransform", {16}},
                                                                {"CoordSysTransform", name},
                                                                {"CoordinateSystem", name},
                                                                {"Film", typed},
                                                                {"Identity", nothing},
                                                                {"Import", name},
                                                                {"Include", name},
                                                                {"Integrator", typed},
                                                                {"LightSource", typed},
                                                                {"LookAt", {9}},
                                                                {"MakeNamedMaterial", typed},
                                                                {"MakeNamedMedium", typed},
                                                                {"Material", typed},
                                                                {"MediumInterface", {0, 1, 2}},
                                                                {"NamedMaterial", name},
                                                                {"ObjectBegin", name},
                                                                {"ObjectEnd", nothing},
                                                                {"ObjectInstance", name},
                                                                {"Option", {0, 0, 0, true}},
                                                                {"PixelFilter", typed},
                                                                {"ReverseOrientation", nothing},
                                                                {"Rotate", {4}},
                                                                {"Sampler", typed},
                                                                {"Scale", {3}},
                                                                {"Shape", typed},
                                                                {"Texture", {0, 3, 3, true}},
                                                                {"Transform", {16}},
                                                                {"TransformBegin", nothing},
                                                                {"TransformEnd", nothing},
                                                                {"TransformTimes", {2}},
                                                                {"Translate", {3}},
                                                                {"WorldBegin", nothing}};
    return table;
}

std::string unknown_directive(std::string_view word) {
    if (word == "WorldEnd") return "'WorldEnd' belongs to pbrt-v3; in pbrt-v4 the file simply ends";
    if (word == "SurfaceIntegrator") return "'SurfaceIntegrator' belongs to older versions; pbrt-v4 says 'Integrator'";
    std::vector<std::string> known;
    for (const auto& [directive, form] : forms()) known.push_back(directive);
    return fmt::format("unknown statement '{}'{}", word.substr(0, 64), did_you_mean(word, known));
}

std::optional<double> parse_double(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<std::int32_t> parse_integer(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    std::int32_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string_view text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes->data()), bytes->size()}; }

/// For messages: a hostile word may be a gigabyte.
std::string_view shortened(std::string_view raw) { return raw.substr(0, 64); }

}  // namespace

Syntax::Syntax(std::string file, Bytes bytes, Report& report)
    : bytes_(std::move(bytes)), report_(report), tokens_(std::move(file), text_of(bytes_), report) {}

std::optional<Statement> Syntax::next() {
    while (!report_.full()) {
        const auto token = tokens_.next();
        if (!token) return std::nullopt;
        if (token->kind == Token::Kind::word && forms().contains(token->raw)) {
            if (auto statement = read_statement(*token)) return statement;
            continue;
        }
        report_.error(tokens_.here(),
                      token->kind == Token::Kind::word
                          ? unknown_directive(token->raw)
                          : fmt::format("a statement must begin here, not '{}'", shortened(token->raw)));
        skip_to_directive();
    }
    return std::nullopt;
}

std::optional<Statement> Syntax::read_statement(const Token& word) {
    const Form& form = forms().find(word.raw)->second;
    const SourceLine where = tokens_.here();
    const std::string directive(word.raw);
    Statement statement{directive, where, {}, {}, Parameters(directive, where, report_)};
    if (form.numbers && !read_numbers(statement, form.numbers)) return std::nullopt;
    read_names(statement, form.least_names, form.most_names, form.bare);
    if (static_cast<int>(statement.names.size()) < form.least_names) {
        report_.error(where, fmt::format("{} needs {} in quotes behind it", directive,
                                         form.least_names == 1 ? "a name" : fmt::format("{} names", form.least_names)));
        skip_to_directive();
        return std::nullopt;
    }
    if (!form.parameters) return statement;
    if (!statement.names.empty())
        statement.parameters = Parameters(fmt::format("{} '{}'", directive, statement.names[0]), where, report_);
    read_parameters(statement);
    return statement;
}

void Syntax::read_names(Statement& statement, int least, int most, bool bare) {
    const bool bracket = least > 0 && tokens_.peek() && tokens_.peek()->kind == Token::Kind::open;
    if (bracket) tokens_.next();
    for (int i = 0; i < most && tokens_.peek(); ++i) {
        const auto kind = tokens_.peek()->kind;
        if (kind != Token::Kind::text && !(bare && kind == Token::Kind::word)) break;
        statement.names.push_back(unescape(tokens_.next()->raw));
    }
    if (bracket && tokens_.peek() && tokens_.peek()->kind == Token::Kind::close) tokens_.next();
}

bool Syntax::read_numbers(Statement& statement, int count) {
    const bool bracket = tokens_.peek() && tokens_.peek()->kind == Token::Kind::open;
    if (bracket) tokens_.next();
    while (static_cast<int>(statement.numbers.size()) < count) {
        const auto token = tokens_.peek();
        const auto value = token && token->kind == Token::Kind::word ? parse_double(token->raw) : std::nullopt;
        if (!value) {
            report_.error(token ? SourceLine{tokens_.file(), token->line} : tokens_.here(),
                          fmt::format("{} needs {} numbers, but number {} is {}", statement.directive, count,
                                      statement.numbers.size() + 1,
                                      token ? fmt::format("'{}'", shortened(token->raw)) : "missing"));
            skip_to_directive();
            return false;
        }
        tokens_.next();
        statement.numbers.push_back(*value);
    }
    if (!bracket) return true;
    if (tokens_.peek() && tokens_.peek()->kind == Token::Kind::close) {
        tokens_.next();
        return true;
    }
    report_.error(tokens_.here(), fmt::format("{} takes {} numbers and then a ']'", statement.directive, count));
    skip_to_directive();
    return false;
}

void Syntax::read_parameters(Statement& statement) {
    while (tokens_.peek() && tokens_.peek()->kind == Token::Kind::text && !report_.full()) {
        const Token declaration = *tokens_.next();
        read_parameter(statement, declaration);
    }
}

void Syntax::read_parameter(Statement& statement, const Token& declaration) {
    const std::string& owner = statement.parameters.owner();
    Parameter parameter;
    parameter.where = tokens_.here();
    bool good = declare(parameter, declaration, owner);
    const std::size_t count = read_values(parameter, good);
    if (!good) return;
    if (count == 0) {
        report_.error(parameter.where, fmt::format("{}: parameter '{}' has no value", owner, parameter.name));
    } else if (parameter.numbers.size() % width_of(parameter.type) != 0) {
        report_.error(
            parameter.where,
            fmt::format("{}: parameter '{}' of type {} has {} numbers, which is no multiple of {}", owner,
                        parameter.name, name_of(parameter.type), parameter.numbers.size(), width_of(parameter.type)));
    } else {
        statement.parameters.add(std::move(parameter));
    }
}

bool Syntax::declare(Parameter& parameter, const Token& declaration, const std::string& owner) {
    const std::string text = unescape(declaration.raw);
    const auto type_end = text.find_first_of(" \t");
    const auto name_start = text.find_first_not_of(" \t", type_end);
    if (type_end == std::string::npos || name_start == std::string::npos) {
        report_.error(parameter.where,
                      fmt::format("{}: a parameter is written \"type name\", not \"{}\"", owner, shortened(text)));
        return false;
    }
    const std::string word = text.substr(0, type_end);
    parameter.name = text.substr(name_start, text.find_last_not_of(" \t") + 1 - name_start);
    const auto type = type_named(word);
    if (!type) {
        report_.error(parameter.where,
                      fmt::format("{}: parameter '{}' has the unknown type '{}'{}", owner, shortened(parameter.name),
                                  shortened(word), did_you_mean(word, type_names())));
        return false;
    }
    if (name_of(*type) != word)
        report_.warn(parameter.where,
                     fmt::format("type '{}' is an older spelling, read as '{}'", word, name_of(*type)));
    parameter.type = *type;
    return true;
}

std::size_t Syntax::read_values(Parameter& parameter, bool& good) {
    const bool bracket = tokens_.peek() && tokens_.peek()->kind == Token::Kind::open;
    if (bracket) tokens_.next();
    std::size_t count = 0;
    bool closed = false;
    while (bracket || count == 0) {
        const auto token = tokens_.peek();
        closed = token && token->kind == Token::Kind::close;
        if (!token || closed || token->kind == Token::Kind::open) break;
        // a missing ']' must not swallow the statements behind it
        if (token->kind == Token::Kind::word && forms().contains(token->raw)) break;
        tokens_.next();
        ++count;
        if (good) good = read_value(parameter, *token);
    }
    if (bracket && closed) tokens_.next();
    if (bracket && !closed)
        report_.error(tokens_.here(), fmt::format("parameter '{}': ']' is missing", shortened(parameter.name)));
    return count;
}

bool Syntax::read_value(Parameter& parameter, const Token& token) {
    const bool quoted = token.kind == Token::Kind::text;
    const auto wrong = [&](std::string_view expected) {
        report_.error(tokens_.here(), fmt::format("parameter '{}': {} expected, not '{}'", parameter.name, expected,
                                                  shortened(token.raw)));
        return false;
    };
    switch (parameter.type) {
        case Type::text:
        case Type::texture:
            if (!quoted) return wrong("a text in quotes");
            parameter.texts.push_back(unescape(token.raw));
            return true;
        case Type::boolean:
            if (token.raw != "true" && token.raw != "false") return wrong("true or false");
            parameter.booleans.push_back(token.raw == "true");
            return true;
        case Type::integer:
            if (const auto value = quoted ? std::nullopt : parse_integer(token.raw)) {
                parameter.integers.push_back(*value);
                return true;
            }
            return wrong("a whole number");
        case Type::spectrum:
            if (!quoted) return read_number_value(parameter, token);
            parameter.texts.push_back(unescape(token.raw));
            return true;
        default:
            return quoted ? wrong("a number") : read_number_value(parameter, token);
    }
}

bool Syntax::read_number_value(Parameter& parameter, const Token& token) {
    const auto value = parse_double(token.raw);
    if (!value || !std::isfinite(static_cast<float>(*value))) {
        report_.error(tokens_.here(),
                      fmt::format("parameter '{}': a number expected, not '{}'", parameter.name, shortened(token.raw)));
        return false;
    }
    parameter.numbers.push_back(static_cast<float>(*value));
    return true;
}

void Syntax::skip_to_directive() {
    while (tokens_.peek()) {
        const Token& token = *tokens_.peek();
        if (token.kind == Token::Kind::word && forms().contains(token.raw)) return;
        tokens_.next();
    }
}

}  // namespace lightnet::pbrt
