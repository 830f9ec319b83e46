// The table of faults: how each row is called, what is done in it, what is promised, and how long it may take.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace lightnet::test {

struct Row {
    int number;
    std::string_view name;     // by which one asks for it
    std::string_view fault;    // what is done
    std::string_view promise;  // what comes of it
    std::string_view test;     // Faults.<test> plays it
    std::chrono::seconds limit;
};

/// On two idle cores all of them together take about ten minutes; the limits are for busy machines.
inline constexpr std::array rows = {
    Row{1, "killed", "workers are killed", "same bytes, noticed within 2 s", "OfWorkersThatAreKilledChangeNoByte",
        std::chrono::seconds(240)},
    Row{2, "stopped", "workers hang and wake", "same bytes, noticed within 2 s", "OfWorkersThatHangAndWakeChangeNoByte",
        std::chrono::seconds(240)},
    Row{3, "straggler", "a worker has a tenth of its time", "same bytes, not slower than without it",
        "OfAStragglerChangeNoByte", std::chrono::seconds(180)},
    Row{4, "partition", "lines hang, both ways and one way", "same bytes, work goes on within 3 s",
        "OfLinesThatHangChangeNoByte", std::chrono::seconds(240)},
    Row{5, "bad-line", "50 ms, 20 Mbit/s, 5 % lost", "same bytes, nobody is taken for dead",
        "OfALineThatIsBadChangeNothingButTheTime", std::chrono::seconds(180)},
    Row{6, "resets", "resets, cut packets, flipped bits", "same bytes, nothing counted twice",
        "OfLinesThatBreakAndDamageChangeNoByte", std::chrono::seconds(240)},
    Row{7, "repeated", "replies late, twice, out of order", "same bytes, nothing counted twice",
        "OfRepliesThatComeLateAndTwiceChangeNoByte", std::chrono::seconds(180)},
    Row{8, "launcher", "the launcher is killed, and resumed", "same bytes, no half picture",
        "OfALauncherThatIsKilledAndResumedChangeNoByte", std::chrono::seconds(420)},
    Row{9, "full-disk", "the picture's disk is full", "old file or new, whole; code 1; nothing is lost",
        "OfADiskThatIsFullLeaveOldFilesWhole", std::chrono::seconds(180)},
    Row{10, "packets", "damaged and oversized packets", "dropped; the memory stays; same bytes",
        "OfPacketsThatAreBombsAreDropped", std::chrono::seconds(180)},
    Row{11, "versions", "peers of all other versions", "refused by name, within 100 ms", "OfVersionsAreRefusedByName",
        std::chrono::seconds(120)},
    Row{12, "keys", "wrong key, unknown key, no key", "not a byte gets in", "OfKeysLetNobodyIn",
        std::chrono::seconds(120)},
    Row{13, "gatekeeper", "the handler of keys dies", "nobody gets in", "OfTheGatekeeperLetNobodyIn",
        std::chrono::seconds(60)},
    Row{14, "scan", "port scan, HTTP, garbage, half handshakes", "same bytes, descriptors come back",
        "OfStrayConnectionsAreShedInTime", std::chrono::seconds(300)},
    Row{15, "descriptors", "no descriptors are left", "refused or lost, never aborted; serves again",
        "OfDescriptorsEndNoProcess", std::chrono::seconds(180)},
    Row{16, "lua", "hostile graph files", "code 2 and one error, in little time and memory",
        "OfHostileGraphFilesEndWithOneError", std::chrono::seconds(240)},
    Row{17, "input", "damaged scenes and pictures", "code 2, file and line; a grey picture",
        "OfDamagedInputEndWithFileAndLine", std::chrono::seconds(180)},
    Row{18, "not-finite", "light that is not finite", "counted by name; no such pixel",
        "OfLightThatIsNotFiniteIsCounted", std::chrono::seconds(120)},
    Row{19, "memory", "a host has too little memory", "same bytes, the others go on", "OfMemoryTakeOutOneHostOnly",
        std::chrono::seconds(180)},
    Row{20, "clocks", "clocks are wrong and jump", "same bytes, nobody is taken for dead",
        "OfClocksThatAreWrongChangeNothing", std::chrono::seconds(180)},
    Row{21, "crowd", "many workers, many places", "same bytes", "OfACrowdOfWorkersAreNone", std::chrono::seconds(300)},
    Row{22, "slow-consumer", "a consumer that is too slow", "memory stays flat", "OfAConsumerThatIsSlowFillNoMemory",
        std::chrono::seconds(180)},
    Row{23, "slurm", "Slurm loses a node, its controller", "same bytes, nodes come back",
        "OfSlurmsNodesAndControllerChangeNoByte", std::chrono::seconds(240)},
    Row{24, "sick-disk", "a daemon's cache is on a sick disk", "same bytes, the others go on",
        "OfOneHostsDiskTakeOutThatHostOnly", std::chrono::seconds(180)},
    Row{25, "no-threads", "a daemon may start no threads", "same bytes, the others go on",
        "OfThreadsTakeOutOneHostOnly", std::chrono::seconds(180)},
    Row{26, "strangers", "strangers say plan, end, blob, join", "same bytes, nobody learns a thing",
        "OfStrangersOrdersAreObeyedByNobody", std::chrono::seconds(240)},
    Row{27, "holders", "who has results is lost, slow, lies", "same bytes, from elsewhere, nobody is taken out",
        "OfThoseWhoHaveResultsChangeNoByte", std::chrono::seconds(240)},
};

}  // namespace lightnet::test
