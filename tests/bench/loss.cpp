// 100 workers killed, 50 stopped, 100 lines cut, bits flipped: runs the tests of exactly this, at full length, or
// briefly (smoke()).
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "tests/bench/figure.hpp"
#include "tests/bench/judge.hpp"

namespace {

// What the command says, which is shown as well; and its wait status, -1: it could not be started.
std::pair<std::string, int> output_of(const std::string& command) {
    std::FILE* const out = popen(command.c_str(), "r");
    if (!out) return {"", -1};
    std::string all;
    std::array<char, 4096> line;
    while (std::fgets(line.data(), line.size(), out)) {
        std::fputs(line.data(), stdout);
        all += line.data();
    }
    return {all, pclose(out)};
}

}  // namespace

int main() {
    const std::string tests = lightnet::bench::sized(LIGHTNET_STARTS_CUT_LARGE_TEST, LIGHTNET_STARTS_CUT_TEST);
    bool ran = true;
    for (const std::string name :
         {"WorkersThatAreKilledAgainAndAgainAreStartedAnew", "HostsThatAreStoppedAgainAndAgainAreLostAndFound",
          "LinesHealAndChangeNoByte", "LinesOfHostsThatDialledInHealToo", "DamagedBytesAreNeverTakenForAnswers"}) {
        const auto [output, status] = output_of(tests + " --gtest_brief=1 --gtest_filter=Cut." + name);
        const bool same = status == 0 && lightnet::bench::one_test_passed(output);
        ran &= status != -1 && WIFEXITED(status) && (status != 0 || same);  // a test that is not there is no figure
        std::printf("loss.%s %s %s\n", name.c_str(), same ? "same bytes" : "differs", same ? "ok" : "short");
        std::fflush(stdout);
    }
    return ran ? 0 : 1;
}
