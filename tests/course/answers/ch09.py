"""Wrong answers to chapter 9 (see `tests.course.answers`)."""


def everywhere(method):
    return dict.fromkeys(("foot.l", "foot.r", "hand.r", "hand.l"), method)


WRONG = {
    "09.mix": [
        (everywhere("transpose"), "mm from their targets"),
        (everywhere("sdls"), "shakes by"),
        (everywhere("pseudoinverse"), "shakes by"),
        (everywhere("dls") | {"foot.l": "newton"}, "is none of"),
        ({"foot.l": "sdls"}, "has no method"),
        (everywhere("sdls") | {"head": "dls"}, "no effector"),
        ("sdls", "a dictionary"),
        (everywhere("pseudoinverse") | {"hand.l": "sdls"}, "shakes by"),  # it may freeze
    ],
}
