### Web pages: layout, login, settings and errors.

## Layout

web-skip = Skip to content
web-nav = Main
web-nav-sessions = Sessions
web-nav-flight = My flight
web-nav-live = Live
web-nav-trainees = Trainees
web-nav-classes = Classes
web-nav-cohort = Cohort
web-nav-scenarios = Scenarios
web-nav-settings = Settings
web-nav-account = Account
web-who = { $name }, { $role }
web-log-out = Log out
web-open = Local access, no login
web-language = Language
web-role-trainee = trainee
web-role-instructor = instructor
web-role-administrator = administrator
web-pages = Pages
web-pages-newest = newest
web-pages-newer = newer
web-pages-at = page { $page } of { $last }
web-pages-older = older
web-pages-oldest = oldest
web-home = Back to the home page
web-back = Back
web-back-to-session = Back to the session
web-back-to-sessions = All sessions
web-back-to-cohort = Back to the cohort
web-toml-note = The file is validated before it is saved, and all errors are listed with line and key. The comments at its beginning explain the format.
web-validate-and-save = Validate and save
web-no-script = This page requires JavaScript.
web-not-saved = Not saved.

## Login and account

web-login = Log in
web-login-name = Name
web-login-password = Password
web-account = Account
web-account-current = Current password
web-account-new = New password, at least { $least } characters
web-account-change = Change password
web-account-changed = Password changed. You have been logged out everywhere else.
web-account-changed-elsewhere = your password was changed elsewhere: log in again with the new one
web-account-data = My data
web-account-progress = My progress and plan
web-account-download = Download all my data
web-password-length =
    the password has { $length ->
        [one] { $length } character
       *[other] { $length } characters
    } (allowed: { $least } to { $most })
web-password-weak = the password is too easy to guess; use several unrelated words
web-password-weak-because = the password is too easy to guess ({ $reason }); use several unrelated words
web-password-rows = Straight rows of keys are easy to guess.
web-password-keyboard = Short keyboard patterns are easy to guess.
web-password-repeats = Repeats like "aaa" are easy to guess.
web-password-repeated-words = Repeats like "abcabcabc" are only slightly harder to guess than "abc".
web-password-top-10 = This is a top-10 common password.
web-password-top-100 = This is a top-100 common password.
web-password-common = This is a very common password.
web-password-similar = This is similar to a commonly used password.
web-password-sequences = Sequences like abc or 6543 are easy to guess.
web-password-years = Recent years are easy to guess.
web-password-word = A word by itself is easy to guess.
web-password-dates = Dates are often easy to guess.
web-password-names = Names and surnames by themselves are easy to guess.
web-password-common-names = Common names and surnames are easy to guess.

## Settings

web-settings = Settings
web-settings-logins = Login accounts
web-settings-add = Add or update a user
web-settings-retention = Retention
web-settings-storage = Storage
web-settings-database = Database
web-settings-folders = Session folders
web-settings-version = Version
web-settings-open = No passwords are set: anyone on this machine has full access, and the server accepts connections only from this machine. After the first password is set, everyone must log in, so set an administrator's password first.
web-settings-users = Users with a password
web-settings-name = Name
web-settings-role = Role
web-settings-action = Action
web-settings-disable = Disable login
web-settings-disable-for = Disable login for { $name }
web-settings-pseudonym = Pseudonym
web-settings-password = Password, at least { $least } characters
web-settings-save = Save
web-settings-erase-days = Erase sessions and session folders older than this (days)
web-settings-erase-sure = I understand that this cannot be undone
web-settings-erase = Erase
web-settings-can-log-in = { $name } can now log in as { $role }.
web-settings-erased =
    Erased { $sessions ->
        [one] { $sessions } session
       *[other] { $sessions } sessions
    } and { $folders ->
        [one] { $folders } folder
       *[other] { $folders } folders
    }.
web-settings-first-administrator = the first user with a password must be an administrator: from then on, everyone must log in, and only administrators can add users
web-settings-lock-out-role = you would lock yourself out: ask another administrator to change your role
web-settings-lock-out = you would lock yourself out
web-settings-no-password = this person has no password

## Errors

web-error-not-found = Not found
web-error-not-found-text = This page does not exist, or you do not have access to it.
web-error-login = Log in
web-error-login-text = Please log in first.
web-error-forbidden = Not allowed
web-error-invalid = Invalid request
web-error-too-large = Too large
web-error-too-large-text = The request is too large (allowed: { $most } bytes).
web-error-wait = Please wait
web-error-wait-text = Too many failed logins. Please wait { $seconds } s.
web-error-busy = Server busy
web-error-busy-text = The server is busy. Try again in { $seconds } s.
web-error-internal = Internal error
web-error-internal-text = Details are in the server's log. Please contact the administrator.
web-error-instructors = This page is for instructors only.
web-error-administrators = This page is for administrators only.
web-error-no-changes = This page does not accept changes.
web-error-expired = This form has expired. Please reload its page and submit it again.
web-error-credentials = Wrong user name or password.
web-error-host-header = The request must have exactly one valid Host header.
web-error-local-only = Without a password, the server responds only to localhost and 127.0.0.1.
web-error-host-name = This host name is not configured on the server. The administrator can add it with --host NAME.
web-error-other-site = This request came from another site.
web-error-proxy-only = This server accepts requests only from its proxy (--trusted-proxy).
web-error-timed-out = the form upload timed out
web-error-one-file = only one file is allowed
web-error-no-file-form = the request does not contain a form with a file
web-error-slow = the upload was too slow (allowed: { $rate } KiB/s or more)
web-error-missing = { $field }: missing
web-error-unknown = { $field }: unknown
web-error-unknown-name = { $field }: unknown name
web-error-unknown-allowed = { $field }: unknown (allowed: { $allowed })
web-error-unknown-value = { $field } = { $value }: unknown (allowed: { $allowed })
web-error-number = { $field }: invalid number (allowed: { $least } to { $most })
web-error-not-confirmed = sure: not confirmed (allowed: yes)
web-error-line = { $field }: { $count } characters (allowed: { $least } to { $most }, on one line)
web-error-id = { $field }: '{ $value }' is not a trainee ID (allowed: 1 to 32 letters, digits, '-' or '_', starting with a letter or digit)
web-error-not-text = { $file }: not UTF-8 text (byte { $byte })
