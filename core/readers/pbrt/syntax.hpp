// The statements of a pbrt file, before anybody knows what they mean.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/readers/files/files.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/tokenizer.hpp"
#include "core/readers/pbrt/version.hpp"

namespace lightnet::pbrt {

/// One statement: `Shape "sphere" "float radius" 2`.
struct Statement {
    std::string directive;  // "Shape"
    SourceLine where;
    std::vector<std::string> names;  // what stands in quotes before the parameters: "sphere"
    std::vector<double> numbers;     // of LookAt, Rotate …
    Parameters parameters;
};

/// Reads the statements of one file. Broken ones are reported and skipped. The report must outlive it.
class Syntax {
public:
    Syntax(std::string file, Bytes bytes, Version version, Report& report);

    /// The next sound statement; none when the file has ended.
    std::optional<Statement> next();

private:
    std::optional<Statement> read_statement(const Token& word);
    void read_names(Statement& statement, int least, int most, bool bare);
    bool read_numbers(Statement& statement, int count);
    void read_parameters(Statement& statement);
    void read_parameter(Statement& statement, const Token& declaration);
    bool declare(Parameter& parameter, const Token& declaration, const std::string& owner);
    /// How many values there are; `good` becomes false at the first broken one, which is reported.
    std::size_t read_values(Parameter& parameter, bool& good);
    bool read_value(Parameter& parameter, const Token& token);
    bool read_number_value(Parameter& parameter, const Token& token);
    void skip_to_directive();

    Bytes bytes_;
    Version version_;
    Report& report_;
    Tokenizer tokens_;
};

}  // namespace lightnet::pbrt
