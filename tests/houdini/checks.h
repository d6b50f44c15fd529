// The groups of checks of houdini_test.
#pragma once

void check_timeline();
void check_edits();
void check_faults();
void check_attributes();
void check_panel();
void check_source();
void check_session();
void check_threads();
