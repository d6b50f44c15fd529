// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "SYS/SYS_Types.h"

// Frame 1 is at 0 seconds.
class CH_Manager {
 public:
    fpreal getSamplesPerSec() const { return samples_per_second_; }
    fpreal getSample(fpreal time) const { return time * samples_per_second_ + 1.0; }

    // The double's own.
    void set_rate(fpreal samples_per_second) { samples_per_second_ = samples_per_second; }
    fpreal time_of_sample(fpreal sample) const { return (sample - 1.0) / samples_per_second_; }

 private:
    fpreal samples_per_second_ = 24.0;
};
CH_Manager* CHgetManager();

enum CH_StringMeaning { CH_STRING_LITERAL, CH_OLD_EXPRESSION };
class CH_LocalVariable;
