# Turns kernel text into a C++ source, so that the library carries its device program and needs no file at run time.
#
#   embed_kernels(OUTPUT <file.cpp> SYMBOL <name> FOLDER <folder> ROOTS <file>...)
#
# The C++ file defines, in namespace fontana,
#   const char* const <name>[];       pieces of the text, to be taken together in order
#   const std::size_t <name>_count;
# ROOTS are read in order; an #include "x" of a file in FOLDER is replaced by that file at its first place and dropped
# after that. Other includes stay: those are for C++ only and stand where a device compiler does not look. #line marks
# keep a device compiler's messages pointing at the file a person would edit.
#
# The work is done when the library is built, by this same file as a script, so that an edited kernel is embedded anew.

function(embed_kernels)
    cmake_parse_arguments(embed "" "OUTPUT;SYMBOL;FOLDER" "ROOTS" ${ARGN})
    file(GLOB texts CONFIGURE_DEPENDS "${embed_FOLDER}/*.h")
    string(REPLACE ";" "|" roots "${embed_ROOTS}")  # a list does not survive a command line
    add_custom_command(
        OUTPUT "${embed_OUTPUT}"
        COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${embed_OUTPUT}" "-DSYMBOL=${embed_SYMBOL}" "-DFOLDER=${embed_FOLDER}"
                "-DROOTS=${roots}" -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
        DEPENDS ${texts} ${embed_ROOTS} "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
        COMMENT "Embedding kernels: ${embed_SYMBOL}"
        VERBATIM)
endfunction()

# Puts `kernel_text`, as raw string literals, and their count into the caller's `literals` and `literal_count`.
function(make_literals)
    get_property(rest GLOBAL PROPERTY kernel_text)
    set(longest_literal 8000)  # the C++ standard promises 65535 bytes, some compilers have only 16380
    set(source "")
    set(count 0)
    while(NOT rest STREQUAL "")
        string(LENGTH "${rest}" cut)
        if(cut GREATER longest_literal)
            string(SUBSTRING "${rest}" 0 ${longest_literal} piece)
            string(FIND "${piece}" "\n" cut REVERSE)
            math(EXPR cut "${cut} + 1")
        endif()
        string(SUBSTRING "${rest}" 0 ${cut} piece)
        string(SUBSTRING "${rest}" ${cut} -1 rest)
        string(APPEND source "R\"kernel(${piece})kernel\",\n")
        math(EXPR count "${count} + 1")
    endwhile()
    set(literals "${source}" PARENT_SCOPE)
    set(literal_count ${count} PARENT_SCOPE)
endfunction()

# Appends the text of `path` with its includes to the global property `kernel_text`; functions cannot share a variable.
function(resolve_includes path)
    get_filename_component(file_name "${path}" NAME)
    file(READ "${path}" rest)
    set_property(GLOBAL APPEND_STRING PROPERTY kernel_text "#line 1 \"${file_name}\"\n")
    set(line 1)
    while(rest MATCHES "(^|\n)#include \"([^\"\n]+)\"[^\n]*\n")
        set(included "${CMAKE_MATCH_2}")
        string(FIND "${rest}" "#include \"${included}\"" at)
        string(SUBSTRING "${rest}" 0 ${at} before)
        string(SUBSTRING "${rest}" ${at} -1 rest)
        string(FIND "${rest}" "\n" line_end)
        math(EXPR line_end "${line_end} + 1")
        string(SUBSTRING "${rest}" 0 ${line_end} include_line)
        string(SUBSTRING "${rest}" ${line_end} -1 rest)
        string(REGEX MATCHALL "\n" newlines "${before}")
        list(LENGTH newlines newline_count)
        math(EXPR line "${line} + ${newline_count} + 1")
        set_property(GLOBAL APPEND_STRING PROPERTY kernel_text "${before}")
        if(NOT EXISTS "${FOLDER}/${included}")
            set_property(GLOBAL APPEND_STRING PROPERTY kernel_text "${include_line}")
        else()
            get_property(known GLOBAL PROPERTY "included_${included}")
            if(NOT known)
                set_property(GLOBAL PROPERTY "included_${included}" TRUE)
                resolve_includes("${FOLDER}/${included}")
            endif()
            set_property(GLOBAL APPEND_STRING PROPERTY kernel_text "#line ${line} \"${file_name}\"\n")
        endif()
    endwhile()
    set_property(GLOBAL APPEND_STRING PROPERTY kernel_text "${rest}")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
    string(REPLACE "|" ";" ROOTS "${ROOTS}")
    foreach(root IN LISTS ROOTS)
        resolve_includes("${root}")
    endforeach()
    make_literals()
    file(WRITE "${OUTPUT}" "// Made by cmake/EmbedKernels.cmake out of the kernel files; edit those.\n"
        "#include <cstddef>\n\n"
        "namespace fontana {\n\n"
        "extern const char* const ${SYMBOL}[];\n"
        "extern const std::size_t ${SYMBOL}_count;\n\n"
        "const char* const ${SYMBOL}[] = {\n"
        "// clang-format off\n"
        "${literals}"
        "// clang-format on\n"
        "};\n"
        "const std::size_t ${SYMBOL}_count = ${literal_count};\n\n"
        "}  // namespace fontana\n")
endif()
