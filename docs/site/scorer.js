// Search finds what users read before what maintainers wrote down.
var Scorer = {
    score: function (result) {
        const page = result[0], score = result[4];
        if (/notebook|DECISIONS|CHANGELOG|CONTRIBUTING/.test(page)) return score - 100;
        return /bias|benchmarks|engine|words/.test(page) ? score - 10 : score;
    },
    objNameMatch: 11,
    objPartialMatch: 6,
    objPrio: {0: 15, 1: 5, 2: -5},
    objPrioDefault: 0,
    title: 15,
    partialTitle: 7,
    term: 5,
    partialTerm: 2,
};
