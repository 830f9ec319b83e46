// 100 workers killed, 50 stopped, 100 lines cut, bits flipped: runs the tests of exactly this, at full length.
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <string>

int main() {
    const std::string tests = LIGHTNET_LOSS_TESTS;
    bool ran = true;
    for (const std::string name :
         {"WorkersThatAreKilledAgainAndAgainAreStartedAnew", "HostsThatAreStoppedAgainAndAgainAreLostAndFound",
          "LinesHealAndChangeNoByte", "LinesOfHostsThatDialledInHealToo", "DamagedBytesAreNeverTakenForAnswers"}) {
        const int status = std::system((tests + " --gtest_brief=1 --gtest_filter=Cut." + name).c_str());
        ran &= status != -1 && WIFEXITED(status);
        std::printf("loss.%s %s %s\n", name.c_str(), status == 0 ? "same bytes" : "differs",
                    status == 0 ? "ok" : "short");
        std::fflush(stdout);
    }
    return ran ? 0 : 1;
}
