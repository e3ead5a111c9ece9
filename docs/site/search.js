// Guides come before the pages that name everything: the reference of Python names, the list of modules, the changes.
var Scorer = {
  score: ([page, , , , score]) =>
    /^(api\/|gallery\/|architecture|changelog|contributing|documents|training)/.test(page) ? score - 12 : score,
  objNameMatch: 11,
  objPartialMatch: 3,
  objPrio: { 0: 5, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
