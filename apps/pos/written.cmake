# Manual page and completions, written by the program that was just linked. An instrumented program writes none.
if(POS_SANITIZE OR POS_COVERAGE OR CMAKE_CROSSCOMPILING)
  return()
endif()
set(written ${CMAKE_BINARY_DIR}/written)
file(MAKE_DIRECTORY ${written})
add_custom_command(TARGET pos POST_BUILD
  COMMAND pos man --out ${written}/pos.1
  COMMAND pos completion bash --out ${written}/pos.bash
  COMMAND pos completion zsh --out ${written}/_pos
  COMMAND pos completion fish --out ${written}/pos.fish
  COMMAND gzip -9nf ${written}/pos.1)
install(FILES ${written}/pos.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${written}/pos.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME pos COMPONENT program)
install(FILES ${written}/_pos DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${written}/pos.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
