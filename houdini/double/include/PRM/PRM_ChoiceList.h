// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "PRM/PRM_Name.h"

class PRM_Parm;
class PRM_SpareData;

enum PRM_ChoiceListType {
    PRM_CHOICELIST_REPLACE = 0x0001,
    PRM_CHOICELIST_TOGGLE = 0x0002,
    PRM_CHOICELIST_EXCLUSIVE = 0x1000,
    PRM_CHOICELIST_SINGLE = PRM_CHOICELIST_EXCLUSIVE | PRM_CHOICELIST_REPLACE
};

// Fills `names`, at most `room` of them with the closing one that has no token.
using PRM_ChoiceGenFunc = void (*)(void* data, PRM_Name* names, int room, const PRM_SpareData*, const PRM_Parm*);

class PRM_ChoiceList {
 public:
    PRM_ChoiceList(PRM_ChoiceListType type, PRM_ChoiceGenFunc generate) : type_(type), generate_(generate) {}
    PRM_ChoiceListType getType() const { return type_; }
    PRM_ChoiceGenFunc getChoiceGenerator() const { return generate_; }

 private:
    PRM_ChoiceListType type_;
    PRM_ChoiceGenFunc generate_;
};
