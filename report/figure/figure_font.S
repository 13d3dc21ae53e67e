/* The font of the figures as bytes of the program; RIGCAL_FIGURE_FONT is its file. */
    .section .rodata
    .global rigcal_figure_font_begin
    .global rigcal_figure_font_end
rigcal_figure_font_begin:
    .incbin RIGCAL_FIGURE_FONT
rigcal_figure_font_end:
    .byte 0
    .section .note.GNU-stack, "", %progbits
