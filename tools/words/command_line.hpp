// Rules that the command lines of all our programs share: how mistakes are told, and how help ends.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lightnet {

/// The command line leaves nothing to do: print, and exit with `code`.
struct Finished {
    int code = 0;
    std::string out, err;
};

/// A mistake in the command line of `app`, or of its verb that was chosen: what, and where to read on.
Finished usage_error(const CLI::App& app, const std::string& what);

/// Lets `app` take a command line (without the program's name) apart. Nothing: there is something left to do. Words
/// that `app` does not know come with a suggestion.
std::optional<Finished> take_apart(CLI::App& app, const std::vector<std::string>& arguments);

/// Once a command line is taken apart, `mistake` says what is wrong with all of it, if anything. One for each app.
void when_taken_apart(CLI::App& app, std::function<std::optional<std::string>()> mistake);

/// The help of `app` ends in these command lines.
void add_examples(CLI::App& app, const std::vector<std::string>& lines);

/// What all verbs and programs take: libraries with kinds of nodes (--plugin), and --print-config, which is answered
/// before a command line is taken apart.
void add_everywhere(CLI::App& app, std::vector<std::string>& plugins);

/// `option` takes whole numbers from `least` to `most`, called `unit` in the help ("N", "SECONDS").
CLI::Option* takes_numbers(CLI::Option* option, const char* unit, std::uint64_t least, std::uint64_t most);

/// `option` takes one of these words.
CLI::Option* takes_one_of(CLI::Option* option, const std::vector<std::string>& words);

/// None: it is no number, or an infinite one.
std::optional<double> amount_of(const std::string& text);
/// `option` takes numbers of at least 0, or above it, called `unit` in the help.
enum class Least { zero, above_zero };
CLI::Option* takes_amounts(CLI::Option* option, const char* unit, Least least);

/// `option` takes tcp://HOST:PORT; where one listens, the port may be *.
CLI::Option* takes_endpoint(CLI::Option* option, bool listens);

}  // namespace lightnet
