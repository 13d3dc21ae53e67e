/* The model as a WebAssembly module, as bytes of the program; RIGCAL_LIVE_MODULE is its file, if there is one. */
    .section .rodata
    .global rigcal_live_module_begin
    .global rigcal_live_module_end
rigcal_live_module_begin:
#ifdef RIGCAL_LIVE_MODULE
    .incbin RIGCAL_LIVE_MODULE
#endif
rigcal_live_module_end:
    .byte 0
    .section .note.GNU-stack, "", %progbits
