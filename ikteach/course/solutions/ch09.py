"""Solutions of chapter 9."""

# %% 09.mix
my_mix = {"foot.l": "sdls", "foot.r": "sdls", "hand.r": "transpose", "hand.l": "transpose"}
