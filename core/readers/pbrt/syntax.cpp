#include "core/readers/pbrt/syntax.hpp"

#include <fmt/format.h>

#include <algorithm>
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
                                                                {"Renderer", typed},
                                                                {"ReverseOrientation", nothing},
                                                                {"Rotate", {4}},
                                                                {"Sampler", typed},
                                                                {"Scale", {3}},
                                                                {"Shape", typed},
                                                                {"SurfaceIntegrator", typed},
                                                                {"Texture", {0, 3, 3, true}},
                                                                {"Transform", {16}},
                                                                {"TransformBegin", nothing},
                                                                {"TransformEnd", nothing},
                                                                {"TransformTimes", {2}},
                                                                {"Translate", {3}},
                                                                {"Volume", typed},
                                                                {"VolumeIntegrator", typed},
                                                                {"WorldBegin", nothing},
                                                                {"WorldEnd", nothing}};
    return table;
}

bool is_older(std::string_view directive) {
    return directive == "Renderer" || directive == "SurfaceIntegrator" || directive == "Volume" ||
           directive == "VolumeIntegrator" || directive == "WorldEnd";
}

/// IEC 61966-2-1, white D65. What no screen can show is cut at 0.
void xyz_to_rgb(std::vector<float>& n) {
    for (std::size_t i = 0; i + 2 < n.size(); i += 3) {
        const double x = n[i], y = n[i + 1], z = n[i + 2];
        n[i] = float(std::max(0.0, 3.240479 * x - 1.537150 * y - 0.498535 * z));
        n[i + 1] = float(std::max(0.0, -0.969256 * x + 1.875991 * y + 0.041556 * z));
        n[i + 2] = float(std::max(0.0, 0.055648 * x - 0.204043 * y + 1.057311 * z));
    }
}

std::string unknown_directive(std::string_view word) {
    std::vector<std::string> known;
    for (const auto& [directive, form] : forms())
        if (!is_older(directive)) known.push_back(directive);
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

bool names_file(const std::string& directive) { return directive == "Include" || directive == "Import"; }

void add_text(Parameter& parameter, std::string_view raw) {
    parameter.texts.push_back(unescape(raw));
    parameter.paths.push_back(path_in(raw));
}

/// For messages: a hostile word may be a gigabyte.
std::string_view shortened(std::string_view raw) { return raw.substr(0, 64); }

}  // namespace

Syntax::Syntax(std::string file, Bytes bytes, Version version, Report& report)
    : bytes_(std::move(bytes)), version_(version), report_(report), tokens_(std::move(file), text_of(bytes_), report) {}

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
    if (version_ == Version::v3) statement.parameters.be_lenient();
    read_parameters(statement);
    return statement;
}

void Syntax::read_names(Statement& statement, int least, int most, bool bare) {
    const bool bracket = least > 0 && tokens_.peek() && tokens_.peek()->kind == Token::Kind::open;
    if (bracket) tokens_.next();
    for (int i = 0; i < most && tokens_.peek(); ++i) {
        const auto kind = tokens_.peek()->kind;
        if (kind != Token::Kind::text && !(bare && kind == Token::Kind::word)) break;
        const auto raw = tokens_.next()->raw;
        statement.names.push_back(names_file(statement.directive) ? path_in(raw) : unescape(raw));
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
        if (parameter.xyz) xyz_to_rgb(parameter.numbers);
        statement.parameters.add(std::move(parameter));
    }
}

bool Syntax::declare(Parameter& parameter, const Token& declaration, const std::string& owner) {
    const std::string text = unescape(declaration.raw);
    constexpr std::string_view blank = " \t\r\n";
    const auto type_start = text.find_first_not_of(blank);
    const auto type_end = text.find_first_of(blank, type_start);
    const auto name_start = text.find_first_not_of(blank, type_end);
    if (type_end == std::string::npos || name_start == std::string::npos) {
        report_.error(parameter.where,
                      fmt::format("{}: a parameter is written \"type name\", not \"{}\"", owner, shortened(text)));
        return false;
    }
    const std::string word = text.substr(type_start, type_end - type_start);
    parameter.name = text.substr(name_start, text.find_last_not_of(blank) + 1 - name_start);
    parameter.xyz = word == "xyz" && version_ == Version::v3;
    const auto type = parameter.xyz ? Type::rgb : type_named(word);
    if (!type) {
        report_.error(parameter.where,
                      fmt::format("{}: parameter '{}' has the unknown type '{}'{}", owner, shortened(parameter.name),
                                  shortened(word), did_you_mean(word, type_names())));
        return false;
    }
    if (name_of(*type) != word && version_ == Version::v4)
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
            add_text(parameter, token.raw);
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
            add_text(parameter, token.raw);
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
