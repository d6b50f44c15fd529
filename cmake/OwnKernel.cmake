# fontana_own_kernel(<target> <file> <symbol>)
#
# A kernel that is not of the core, in the dialect of src/fontana/kernels/: `file` is its header, which includes
# "dialect.h" and whatever else it needs of that folder. The target gets the backends, that folder to include from, and
# the file's text for devices as fontana::<symbol> and fontana::<symbol>_count, which a fontana::KernelText points at.
# Names are C++ identifiers. docs/template.md walks through an example.
set(FONTANA_KERNEL_FOLDER ${CMAKE_CURRENT_LIST_DIR}/../src/fontana/kernels CACHE INTERNAL "")

function(fontana_own_kernel target file symbol)
  get_filename_component(path ${file} ABSOLUTE)
  set(text ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.cpp)
  embed_kernels(OUTPUT ${text} SYMBOL ${symbol} FOLDER ${FONTANA_KERNEL_FOLDER} ROOTS ${path})
  target_sources(${target} PRIVATE ${text})
  target_include_directories(${target} PRIVATE ${FONTANA_KERNEL_FOLDER})
  target_link_libraries(${target} PRIVATE fontana_backends)
endfunction()
