// The campaign of faults: plays each row of tests/faults/rows.hpp, or those that are named, and prints the table.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tests/bench/figure.hpp"
#include "tests/faults/rows.hpp"
#include "tests/support/folder.hpp"

namespace {

using lightnet::test::Row;
using Words = std::vector<std::string>;

struct Outcome {
    const Row* row = nullptr;
    bool ran = true, passed = false;
    std::string why_not;
    Words done, seen, figures, complaints;
};

// What follows `word` at the beginning of a line.
bool take(const std::string& line, const std::string& word, Words& into) {
    if (!line.starts_with(word)) return false;
    into.push_back(line.substr(word.size()));
    return true;
}

void read(const std::string& line, Outcome& outcome) {
    Words why;
    if (take(line, "done: ", outcome.done) || take(line, "seen: ", outcome.seen)) return;
    if (take(line, "not run: ", why)) {
        outcome.ran = false;
        outcome.why_not = why.front();
    } else if (line.starts_with("faults.")) {
        outcome.figures.push_back(line);
    } else if (line.find("\"event\":\"progress\"") == std::string::npos) {
        outcome.complaints.push_back(line);
    }
}

Outcome play(const Row& row) {
    Outcome outcome;
    outcome.row = &row;
    const std::string command = LIGHTNET_STARTS_FAULTS_TEST " --gtest_brief=1 --gtest_filter=Faults." +
                                std::string(row.test) + " 2>&1 </dev/null";
    std::FILE* const said = ::popen(command.c_str(), "r");
    if (!said) throw std::runtime_error("can't start " LIGHTNET_STARTS_FAULTS_TEST);
    std::string line;
    for (int c = std::fgetc(said); c != EOF; c = std::fgetc(said)) {
        if (c != '\n') {
            line += static_cast<char>(c);
            continue;
        }
        read(line, outcome);
        line.clear();
    }
    const bool sound = ::pclose(said) == 0;
    outcome.passed = outcome.ran && sound && !outcome.done.empty();
    return outcome;
}

std::string joined(const Words& words) {
    std::string all;
    for (const auto& word : words) all += (all.empty() ? "" : "; ") + word;
    return all;
}

void print(const Outcome& outcome, double seconds) {
    const auto& row = *outcome.row;
    const auto text = [](std::string_view view) { return std::string(view); };
    std::cout << row.number << " " << row.name << ": " << text(row.fault) << " -> " << text(row.promise) << "\n";
    if (!outcome.ran) {
        lightnet::bench::not_run("faults." + text(row.name), outcome.why_not);
        return;
    }
    std::cout << "   done: " << joined(outcome.done) << "\n   seen: " << joined(outcome.seen) << "\n";
    constexpr std::size_t most = 60;
    for (std::size_t i = 0; !outcome.passed && i < std::min(most, outcome.complaints.size()); ++i)
        std::cout << "   | " << outcome.complaints[i].substr(0, 300) << "\n";
    std::printf("   %s after %.0f s\n", outcome.passed ? "passed" : "FAILED", seconds);
    for (const auto& figure : outcome.figures) std::cout << figure << "\n";
    std::cout << "faults." << row.name << " " << text(row.promise) << " " << (outcome.passed ? "ok" : "short")
              << std::endl;
}

// None are named: all of them.
std::vector<const Row*> chosen(int count, char** names) {
    std::vector<const Row*> all;
    for (const auto& row : lightnet::test::rows) {
        const auto is_named = [&](const char* name) { return name == row.name || name == std::to_string(row.number); };
        if (count == 0 || std::any_of(names, names + count, is_named)) all.push_back(&row);
    }
    return all;
}

int count(const std::vector<Outcome>& outcomes) {
    const auto passed = std::count_if(outcomes.begin(), outcomes.end(), [](const auto& one) { return one.passed; });
    const auto ran = std::count_if(outcomes.begin(), outcomes.end(), [](const auto& one) { return one.ran; });
    const auto left_out = static_cast<std::ptrdiff_t>(outcomes.size()) - ran;
    std::printf("%td rows passed, %td failed, %td not run", passed, ran - passed, left_out);
    const char* before = ": ";
    for (const auto& one : outcomes) {
        if (one.ran) continue;
        std::cout << before << one.row->name << " (" << one.why_not << ")";
        before = ", ";
    }
    std::cout << std::endl;
    // Briefly, what rows promise is not judged, as no goal is: each has to come so far that it says what it did.
    const bool all_played =
        std::all_of(outcomes.begin(), outcomes.end(), [](const auto& one) { return !one.ran || !one.done.empty(); });
    return passed == ran || (lightnet::bench::smoke() && all_played) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    std::setvbuf(stdout, nullptr, _IONBF, 0);  // two ways of writing, one order
    const auto rows = chosen(argc - 1, argv + 1);
    if (rows.empty()) {
        std::cerr << "faults: there is no such row; there are";
        for (const auto& row : lightnet::test::rows) std::cerr << ' ' << row.name;
        std::cerr << '\n';
        return 2;
    }
    const lightnet::test::Folder shelf;  // pictures in peace, for all rows
    ::setenv("LIGHTNET_FAULTS_SHELF", shelf.path().c_str(), 1);
    std::vector<Outcome> outcomes;
    for (const auto* row : rows) {
        Outcome outcome;
        const double seconds = lightnet::bench::seconds_of([&] { outcome = play(*row); });
        print(outcome, seconds);
        outcomes.push_back(std::move(outcome));
    }
    return count(outcomes);
}
